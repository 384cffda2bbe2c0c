// Bit pyramids over the octree's grids: one bit a cell, 64 cells (4x4x4, in Morton order) a block.
// A grid of 2^k cells a side has max(1, 8^(k-2)) blocks; the grids stand one after the other,
// coarsest first. Ranks over these bits give every node and brick its place in Morton order,
// which makes a build the same every time, whatever the order in which threads ran.

#include "lib/morton.glsl"

// First block of the grid with 2^k cells a side. (8^n - 1) / 7 sums the smaller grids.
uint grid_first_block(int k) {
    return k < 2 ? uint(k) : 2u + ((1u << (3 * (k - 2))) - 1u) / 7u;
}

uint grid_block_count(int k) {
    return k < 2 ? 1u : 1u << (3 * (k - 2));
}

// The grid exponent that a block belongs to.
int grid_of_block(uint block) {
    if (block < 2u) return int(block);
    // block - 2 lies in [ (8^n - 1) / 7, (8^(n+1) - 1) / 7 ): its n is the octal digit count of 7b + 1.
    return findMSB((block - 2u) * 7u + 1u) / 3 + 2;
}

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
