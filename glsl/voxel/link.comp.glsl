// Hangs every fragment on its voxel's list: one exchange a fragment, where adding its values up here
// would take a dozen atomics and sums as large as the attributes. resolve.comp goes over the lists
// and adds integers, so the averages do not depend on the order.

#include "lib/dispatch.glsl"
#include "lib/regions.glsl"
#include "lib/node_blocks.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer State { OctreeState octree_state; };
// A fragment's position becomes the index + 1 of the next fragment of its voxel, 0 for none.
layout(std430) buffer Fragments { VoxelFragment fragments[]; };
// Cleared: a voxel's albedo holds the index + 1 of its first fragment until it is resolved.
layout(std430) buffer Attributes { VoxelAttributes attributes[]; };

void main() {
    uint index = linear_thread_id();
    if (index >= min(octree_state.fragment_count, u_octree.fragment_capacity)) return;
    int level;
    uvec3 point = leaf_point(unpack_position(fragments[index].position), level);
    uint brick = brick_of_node(ivec3(point >> 1u), level, octree_state.brick_count);
    if (brick == NO_BRICK) return;  // it was dropped, and counted

    uint slot = brick - octree_state.level_first[u_octree.coarsest_leaf];
    uvec3 odd = point & 1u;
    uint voxel = slot * BRICK_VOXELS + (odd.x | (odd.y << 1) | (odd.z << 2));
    fragments[index].position = atomicExchange(attributes[voxel].albedo, index + 1u);
}
