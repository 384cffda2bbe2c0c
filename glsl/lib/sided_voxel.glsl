// Reading any voxel of any level: see lib/voxel.glsl.

#include "lib/voxel.glsl"
#include "shared/sided.glsl"

uint sided_index(uint brick, uint voxel, uint side) {
    return (brick * BRICK_VOXELS + voxel) * BRICK_DIRECTIONS + side;
}

AxisVoxel brick_voxel(uint brick, uint voxel, uint axis) {
    if ((bricks[brick].cell & BRICK_LEAF) != 0u) {
        return leaf_voxel(leaf_slot(brick) * BRICK_VOXELS + voxel, axis);
    }
    uint index = sided_index(brick, voxel, axis * 2u);
    return AxisVoxel(unpack_half4(sided[index]), unpack_half4(sided[index + 1u]));
}

const uint NO_BRICK = 0xffffffffu;

// The brick that holds a cell's points. Where the octree ends above `level`, the deepest brick on
// the way; `reached` says which level that is. NO_BRICK where there is nothing at all.
uint brick_of_cell(ivec3 cell, int level, out int reached) {
    reached = level;
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(1 << level)))) return NO_BRICK;
    Node node = nodes[find_node(uvec3(cell), level, reached)];
    if (!node_has_brick(node)) return NO_BRICK;
    uint brick = node_brick(node);
    // A node without the wanted child stands for it only where its region has no finer level.
    if (reached < level && (bricks[brick].cell & BRICK_LEAF) == 0u) return NO_BRICK;
    return brick;
}

// Occupied points of a cell's brick, a bit each; all, where a coarser neighbour stands for it.
uint points_of_cell(uint brick, int reached, int level) {
    if (brick == NO_BRICK) return 0u;
    return reached < level ? 0xffu : bricks[brick].node >> BRICK_POINTS_SHIFT;
}

// Voxel at a lattice point of `level` in the brick of its cell. A coarser neighbour region lends
// the nearest point that it has.
AxisVoxel axis_voxel_at(uint brick, int reached, uvec3 point, int level, uint axis) {
    return brick_voxel(brick, voxel_of_point(point >> uint(level - reached)), axis);
}
