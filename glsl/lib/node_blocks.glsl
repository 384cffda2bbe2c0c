// The nodes' bits, and with each block of 64 how many bricks and tiles stand before it: what a
// build leaves behind so that a cell's brick is found without a descent.

#include "lib/node_bits.glsl"

// Four words a block: bits, bricks before, tiles before; these count from the start of a group of
// SCAN_BLOCKS. After the blocks four words a group: two unused, bricks and tiles before the group.
// After these, where slots outlive a build, the slot of each brick, then of each tile, by rank.
// NODE_BLOCKS_ACCESS: coherent for who writes them.
#ifndef NODE_BLOCKS_ACCESS
#define NODE_BLOCKS_ACCESS readonly
#endif
layout(std430) NODE_BLOCKS_ACCESS buffer NodeBlocks { uint node_blocks[]; };

const uint BLOCK_WORDS = 4u;

uvec2 block_bits(uint block) {
    return uvec2(node_blocks[block * BLOCK_WORDS], node_blocks[block * BLOCK_WORDS + 1u]);
}

uvec2 block_sums(uint block) {
    return uvec2(node_blocks[block * BLOCK_WORDS + 2u], node_blocks[block * BLOCK_WORDS + 3u]);
}

// Bricks and tiles of a block with these bits.
uvec2 node_counts(uvec2 bits, int level) {
    uint tiles = level > u_octree.top_level ? bit_count64(used_bytes(bits)) : 0u;
    return uvec2(bit_count64(bits), tiles);
}

// Where a group's own sums stand, as the number of a block.
uint group_block(uint group) { return u_octree.block_count + group; }

// Bricks and tiles before a block.
uvec2 block_rank(uint block) {
    return block_sums(block) + block_sums(group_block(block / SCAN_BLOCKS));
}

// Word of the node with this code in the grid of its level; its bit is cell_bit(code).
uint node_word(int level, uint code) {
    return (grid_first_block(level) + (code >> 6)) * BLOCK_WORDS + ((code >> 5) & 1u);
}

const uint NO_BRICK = 0xffffffffu;

// Words of the slots of the brick and of the tile with a rank.
uint brick_slot_word(uint rank) {
    uint groups = (u_octree.block_count + SCAN_BLOCKS - 1u) / SCAN_BLOCKS;
    return group_block(groups) * BLOCK_WORDS + rank;
}
uint tile_slot_word(uint rank) { return brick_slot_word(u_octree.brick_capacity) + rank; }

// The brick and the tile with a rank; both were kept.
uint brick_of_rank(uint rank) {
    return u_octree.keeps_slots == 0u ? rank : node_blocks[brick_slot_word(rank)];
}
uint tile_of_rank(uint rank) {
    return u_octree.keeps_slots == 0u ? rank : node_blocks[tile_slot_word(rank)];
}

// The brick of a cell's node, or NO_BRICK; `brick_count` were kept.
uint brick_of_node(ivec3 cell, int level, uint brick_count) {
    if (!in_grid(level, cell)) return NO_BRICK;
    uint code = grid_code(level, uvec3(cell));
    uint block = grid_first_block(level) + (code >> 6);
    uvec2 bits = block_bits(block);
    uint word = (code & 32u) == 0u ? bits.x : bits.y;
    if ((word & cell_bit(code)) == 0u) return NO_BRICK;
    uint rank = block_rank(block).x + bit_count64(bits & bits_below(code & 63u));
    return rank < brick_count ? brick_of_rank(rank) : NO_BRICK;
}
