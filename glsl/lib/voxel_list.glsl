// The occupied voxels of the octree, listed by nodes.comp in no order: passes over them dispatch a
// thread for each. First those above the leaves, brick * 8 + octant, each level's from its first
// brick * 8 on; then those of the leaves, slot * 8 + octant.

#include "shared/octree.glsl"

layout(std430) readonly buffer VoxelList { uint voxel_list[]; };

uint filtered_voxel_of_item(uint first_brick, uint item) {
    return voxel_list[first_brick * BRICK_VOXELS + item];
}

uint leaf_voxel_of_item(uint item) {
    return voxel_list[u_octree.interior_capacity * BRICK_VOXELS + item];
}
