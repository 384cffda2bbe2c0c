// The occupied voxels of the octree, listed by nodes.comp in no order: passes over them dispatch a
// thread for each. First those above the leaves, brick * 8 + octant, each level's from its first
// brick * 8 on; then those of the leaves, slot * 8 + octant. Where bricks keep their slots, the
// lists hold what is to be done anew, and after them stand the bricks: above the finest level, the
// finest.

#include "shared/octree.glsl"

layout(std430) readonly buffer VoxelList { uint voxel_list[]; };

uint filtered_voxel_of_item(uint first_brick, uint item) {
    return voxel_list[first_brick * BRICK_VOXELS + item];
}

uint leaf_voxel_of_item(uint item) {
    return voxel_list[u_octree.interior_capacity * BRICK_VOXELS + item];
}

uint interior_brick_of_item(uint item) { return voxel_list[u_octree.brick_list + item]; }

uint finest_brick_of_item(uint item) {
    return voxel_list[u_octree.brick_list + u_octree.interior_capacity + item];
}
