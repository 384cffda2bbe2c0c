// Hangs every fragment on its voxel's list: one exchange a fragment, where adding its values up here
// would take a dozen atomics and sums as large as the attributes. resolve.comp goes over the lists
// and adds integers, so the averages do not depend on the order.
//
// KEPT_FRAGMENTS: 0: the queue is of this build alone, and its positions become the links. STILL (1):
// those of what never moves are linked once, on lists of their own; MOVING (2): the others.

#include "lib/dispatch.glsl"
#include "lib/regions.glsl"
#include "lib/node_blocks.glsl"
#include "lib/fragment_lists.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer State { OctreeState octree_state; };

#if KEPT_FRAGMENTS
layout(std430) readonly buffer Fragments { VoxelFragment fragments[]; };
layout(std430) writeonly buffer Links { uint links[]; };  // index + 1 of the next fragment, 0 for none
layout(std430) buffer Heads { uint heads[]; };            // index + 1 of the first, see fragment_lists
#else
// A fragment's position becomes the index + 1 of the next fragment of its voxel, 0 for none.
layout(std430) buffer Fragments { VoxelFragment fragments[]; };
// Cleared: a voxel's albedo holds the index + 1 of its first fragment until it is resolved.
layout(std430) buffer Attributes { VoxelAttributes attributes[]; };
#endif

void main() {
    uint index = linear_thread_id();
    uint end = min(octree_state.fragment_count, u_octree.fragment_capacity);
#if KEPT_FRAGMENTS == STILL_FRAGMENTS
    end = min(octree_state.still_count, end);
#elif KEPT_FRAGMENTS == MOVING_FRAGMENTS
    index += octree_state.still_count;
#endif
    if (index >= end) return;
    int level;
    uvec3 point = leaf_point(unpack_position(fragments[index].position), level);
    uint brick = brick_of_node(ivec3(point >> 1u), level, octree_state.brick_count);
    if (brick == NO_BRICK) return;  // it was dropped, and counted

    uint slot = brick - octree_state.first_leaf_brick;
    uvec3 odd = point & 1u;
    uint voxel = slot * BRICK_VOXELS + (odd.x | (odd.y << 1) | (odd.z << 2));
#if KEPT_FRAGMENTS
    links[index] = atomicExchange(heads[head_of_voxel(voxel, KEPT_FRAGMENTS)], index + 1u);
#else
    fragments[index].position = atomicExchange(attributes[voxel].albedo, index + 1u);
#endif
}
