// What the fragment queue's consumers need to know, once it is filled. One thread. STILL=1: so far it
// holds what never moves.

#include "lib/dispatch_args.glsl"
#ifndef STILL
#define STILL 0
#endif

layout(local_size_x = 1) in;

layout(std430) buffer State { OctreeState octree_state; };

void main() {
    uint kept = min(octree_state.fragment_count, u_octree.fragment_capacity);
#if STILL
    octree_state.still_count = octree_state.fragment_count;
#endif
    uint still = min(octree_state.still_count, kept);
    octree_state.fragments = dispatch_args(kept, FRAGMENT_GROUP);
    octree_state.moving_fragments = dispatch_args(kept - still, FRAGMENT_GROUP);
    octree_state.fragment_dropped = octree_state.fragment_count - kept;
}
