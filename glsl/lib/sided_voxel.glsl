// Reading any voxel of any level: see lib/voxel.glsl.

#include "lib/voxel.glsl"
#include "shared/sided.glsl"
#include "lib/node_blocks.glsl"

// What the voxels to be read can be: leaves, filtered ones, or, where regions have leaves of
// different levels, either.
#define EITHER_VOXELS 0
#define LEAF_VOXELS 1
#define FILTERED_VOXELS 2
#ifndef VOXEL_KIND
#define VOXEL_KIND EITHER_VOXELS
#endif
// 1: all regions have the finest leaf level.
#ifndef ONE_LEAF_LEVEL
#define ONE_LEAF_LEVEL 0
#endif

Sides filtered_sides(uint voxel) {
    uint first = voxel * BRICK_STACKS;
    Sides s;
    for (uint axis = 0u; axis < 3u; ++axis) {
        s.plus[axis] = unpack_half4(sided[first + axis * 2u]);
        s.minus[axis] = unpack_half4(sided[first + axis * 2u + 1u]);
    }
    return s;
}

Sides sides_of_voxel(uint brick, uint voxel) {
#if VOXEL_KIND == LEAF_VOXELS
    return leaf_sides(leaf_slot(brick) * BRICK_VOXELS + voxel);
#elif VOXEL_KIND == FILTERED_VOXELS
    return filtered_sides(brick * BRICK_VOXELS + voxel);
#else
    if ((bricks[brick].cell & BRICK_LEAF) != 0u)
        return leaf_sides(leaf_slot(brick) * BRICK_VOXELS + voxel);
    return filtered_sides(brick * BRICK_VOXELS + voxel);
#endif
}

// Opacities along the axes: a voxel hides the same towards both sides.
vec3 filtered_opacity(uint voxel) {
    return unpack_half4(sided[voxel * BRICK_STACKS + BRICK_DIRECTIONS]).xyz;
}

vec3 opacity_of_voxel(uint brick, uint voxel) {
#if VOXEL_KIND == LEAF_VOXELS
    return leaf_opacities(leaf_slot(brick) * BRICK_VOXELS + voxel);
#elif VOXEL_KIND == FILTERED_VOXELS
    return filtered_opacity(brick * BRICK_VOXELS + voxel);
#else
    if ((bricks[brick].cell & BRICK_LEAF) != 0u)
        return leaf_opacities(leaf_slot(brick) * BRICK_VOXELS + voxel);
    return filtered_opacity(brick * BRICK_VOXELS + voxel);
#endif
}

// The brick that holds a cell's points, or NO_BRICK; `reached` says which level it is of. Where the
// octree ends above `level`, the leaf of a coarser region stands for the cell.
uint brick_of_cell(ivec3 cell, int level, out int reached) {
    reached = level;
    uint brick = brick_of_node(cell, level, octree_state.brick_count);
#if ONE_LEAF_LEVEL == 0
    while (brick == NO_BRICK && reached > u_octree.coarsest_leaf) {
        --reached;
        uint coarser = brick_of_node(cell >> (level - reached), reached, octree_state.brick_count);
        if (coarser == NO_BRICK) continue;
        if ((bricks[coarser].cell & BRICK_LEAF) == 0u) break;
        brick = coarser;
    }
#endif
    return brick;
}

// Occupied points of a cell's brick, a bit each; all, where a coarser neighbour stands for it.
uint points_of_cell(uint brick, int reached, int level) {
    if (brick == NO_BRICK) return 0u;
    return reached < level ? 0xffu : bricks[brick].node >> BRICK_POINTS_SHIFT;
}
