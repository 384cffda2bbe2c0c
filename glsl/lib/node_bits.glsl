// Bit pyramids over the octree's grids: one bit a cell, 64 cells (4x4x4, in Morton order) a block.
// A grid of exponent k has 2^k cells a side of the cube. Up to top_level + 1 all of them have a
// bit; finer grids have bits for the scene alone, the middle half along each axis. The grids stand
// one after the other, coarsest first. Ranks over these bits give every node and brick its place
// in Morton order, which makes a build the same every time, whatever the order of threads.

#include "shared/octree.glsl"
#include "lib/morton.glsl"

bool grid_is_full(int k) { return k <= u_octree.top_level + 1; }

// First cell along an axis that has a bit, and how many do.
uint grid_offset(int k) { return grid_is_full(k) ? 0u : 1u << (k - 2); }
uint grid_side(int k) { return grid_is_full(k) ? 1u << k : 1u << (k - 1); }

uint grid_block_count(int k) {
    int side_log2 = grid_is_full(k) ? k : k - 1;
    return side_log2 < 2 ? 1u : 1u << (3 * (side_log2 - 2));
}

// (8^n - 1) / 7: the sum of 8^i for i < n.
uint octal_sum(int n) { return ((1u << (3 * n)) - 1u) / 7u; }

uint grid_first_block(int k) {
    if (k < 2) return uint(k);
    int full = min(k, u_octree.top_level + 2);
    uint first = 2u + octal_sum(full - 2);
    return k <= full ? first : first + octal_sum(k - 3) - octal_sum(full - 3);
}

int grid_of_block(uint block) {
    int k = 0;
    while (block >= grid_first_block(k + 1)) ++k;
    return k;
}

bool in_grid(int k, ivec3 cell) {
    ivec3 shifted = cell - int(grid_offset(k));
    return all(greaterThanEqual(shifted, ivec3(0))) && all(lessThan(shifted, ivec3(grid_side(k))));
}

// Morton code of a cell inside its grid, and back.
uint grid_code(int k, uvec3 cell) { return morton_encode(cell - grid_offset(k)); }
uvec3 grid_cell(int k, uint code) { return morton_decode(code) + grid_offset(k); }

// Word index and bit of a cell.
uint cell_word(int k, uint code) { return grid_first_block(k) * 2u + (code >> 5); }
uint cell_bit(uint code) { return 1u << (code & 31u); }

// Bits below bit b (0..64) of a 64 bit block.
uvec2 bits_below(uint b) {
    return uvec2(b >= 32u ? 0xffffffffu : (1u << b) - 1u,
                 b >= 64u ? 0xffffffffu : (b > 32u ? (1u << (b - 32u)) - 1u : 0u));
}

uint bit_count64(uvec2 bits) { return uint(bitCount(bits.x) + bitCount(bits.y)); }

// One bit for each non-zero byte of the block, at the byte's lowest bit: sibling groups in use.
uvec2 used_bytes(uvec2 bits) {
    bits |= bits >> 4;
    bits |= bits >> 2;
    bits |= bits >> 1;
    return bits & 0x01010101u;
}
