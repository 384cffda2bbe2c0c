// The leaf level of each region of the octree's cube.
// [Mittring12 "Sparse Voxel Octree": mapping function allows locally higher resolution]

#include "lib/lattice.glsl"

// Leaf level of each of the REGION_SIDE^3 regions, x fastest.
layout(std430) readonly buffer Regions { uint region_leaf_level[]; };

uint region_index(uvec3 region) {
    return region.x + REGION_SIDE * (region.y + REGION_SIDE * region.z);
}

// Leaf level of the region that holds the node `cell` of a level; of a coarse node, its first region's.
int leaf_level_of_cell(uvec3 cell, int level) {
    const int region_level = 3;
    uvec3 region = level >= region_level ? cell >> uint(level - region_level)
                                         : cell << uint(region_level - level);
    return int(region_leaf_level[region_index(region)]);
}

// A fragment's point on the lattice of its region's leaf level. Rounds, but stays in its region.
uvec3 leaf_point(uvec3 finest_point, out int level) {
    level = leaf_level_of_cell(finest_point >> 1u, u_octree.leaf_level);
    uint shift = uint(u_octree.leaf_level - level);
    if (shift == 0u) return finest_point;
    uint region_points = uint(u_octree.resolution) / REGION_SIDE;
    uvec3 last = ((finest_point / region_points + 1u) * region_points - 1u) >> shift;
    return min((finest_point + (1u << (shift - 1u))) >> shift, last);
}
