// The leaf level of each region of the octree's cube.
// [Mittring12 "Sparse Voxel Octree": mapping function allows locally higher resolution]

#include "lib/lattice.glsl"

// Leaf level of each of the REGION_SIDE^3 regions, x fastest.
layout(std430) readonly buffer Regions { uint region_leaf_level[]; };

uint region_index(uvec3 region) {
    return region.x + REGION_SIDE * (region.y + REGION_SIDE * region.z);
}

// Leaf level of the region that holds the node `cell` of a level. Coarser nodes belong to several
// regions and those beside the scene to none; they take the nearest one's.
int leaf_level_of_cell(ivec3 cell, int level) {
    ivec3 at_regions = level >= REGION_LEVEL ? cell >> (level - REGION_LEVEL)
                                             : cell << (REGION_LEVEL - level);
    ivec3 region = at_regions - int(REGION_SIDE / 2u);
    return int(region_leaf_level[region_index(uvec3(clamp(region, 0, int(REGION_SIDE) - 1)))]);
}

// A fragment's point, relative to the scene's corner, on the lattice of its region's leaf level.
// Rounds, but stays in its region. Returns the point in the cube.
uvec3 leaf_point(uvec3 scene_point, out int level) {
    uint corner = uint(u_octree.resolution) / 2u;
    level = leaf_level_of_cell(ivec3((scene_point + corner) >> 1u), u_octree.leaf_level);
    uint shift = uint(u_octree.leaf_level - level);
    if (shift == 0u) return scene_point + corner;
    uint region_points = uint(u_octree.resolution) / REGION_SIDE;
    uvec3 last = ((scene_point / region_points + 1u) * region_points - 1u) >> shift;
    return min((scene_point + (1u << (shift - 1u))) >> shift, last) + (corner >> shift);
}
