// 3x3x3 neighbouring points of a lattice, and which bricks hold them: what filtering reads, and a
// brick with its redundant border. [Mittring12 "Create redundant border"]
//
// They lie in 2x2x2 cells, from lowest_cell on, and begin at the cell's second point along each axis
// (first_point 1) or at its first (0). Point i of the 27 is x + 3 y + 9 z.

#include "lib/sided_voxel.glsl"

struct Surroundings {
    uvec3 lowest_cell;
    int level;
    uint first_point;
    uint occupied;  // a bit for each point that holds anything
};

// The bricks of the eight cells. A thread's own: as shared arrays these and the filter's would leave
// room for few threads, and llvmpipe reads them slower.
uint cell_brick[8];
#if ONE_LEAF_LEVEL == 0
int cell_level[8];  // coarser than the points' beside a coarser region
#endif

// Occupied points of a cell, a byte, as bits of the 27; those outside fall off.
uint bits_of_cell(uint points, uvec3 cell, uint first_point) {
    uvec3 whole = uvec3(equal(cell, uvec3(first_point)));
    uvec3 half_mask = first_point == 0u ? uvec3(0x55u, 0x33u, 0x0fu) : uvec3(0xaau, 0xccu, 0xf0u);
    uvec3 mask = half_mask | (whole * 0xffu);
    points &= mask.x & mask.y & mask.z;
    uint spread = (points & 0x03u) | ((points & 0x0cu) << 1)
                | ((points & 0x30u) << 5) | ((points & 0xc0u) << 6);
    int at = int(2u * cell.x + 6u * cell.y + 18u * cell.z) - int(13u * first_point);
    return at < 0 ? spread >> uint(-at) : spread << uint(at);
}

Surroundings surroundings(ivec3 lowest_cell, int level, uint first_point) {
    Surroundings s = Surroundings(uvec3(lowest_cell), level, first_point, 0u);
    for (uint i = 0u; i < 8u; ++i) {
        uvec3 cell = uvec3(i, i >> 1, i >> 2) & 1u;
        int reached;
        uint brick = brick_of_cell(lowest_cell + ivec3(cell), level, reached);
        s.occupied |= bits_of_cell(points_of_cell(brick, reached, level), cell, first_point);
        cell_brick[i] = brick;
#if ONE_LEAF_LEVEL == 0
        cell_level[i] = reached;
#endif
    }
    return s;
}

uvec3 place_of_point(uint i) { return uvec3(i % 3u, (i / 3u) % 3u, i / 9u); }

// The brick that owns a point, by its place among the 27, and which of its eight it is. A coarser
// neighbour region lends the nearest point that it has.
uint owner_of_point(Surroundings s, uvec3 place, out uint voxel) {
    uvec3 cell = (place + s.first_point) >> 1u;
    uint number = cell.x | (cell.y << 1) | (cell.z << 2);
    uvec3 point = s.lowest_cell * 2u + s.first_point + place;
#if ONE_LEAF_LEVEL == 0
    point >>= uint(s.level - cell_level[number]);
#endif
    voxel = voxel_of_point(point);
    return cell_brick[number];
}
