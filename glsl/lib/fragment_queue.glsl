// The queue of fragments, for passes of a thread a fragment. MOVING=1: only the fragments behind
// those of what never moves.

#include "lib/dispatch.glsl"
#include "shared/octree.glsl"
#ifndef MOVING
#define MOVING 0
#endif

layout(std430) readonly buffer State { OctreeState octree_state; };

// The fragment (uint) of this thread; a macro as linear_thread_id is.
#if MOVING
#define queue_index() (linear_thread_id() + octree_state.still_count)
#else
#define queue_index() linear_thread_id()
#endif

// Whether there is such a fragment: the count is of all that were wanted.
bool is_queued(uint index) {
    return index < min(octree_state.fragment_count, u_octree.fragment_capacity);
}
