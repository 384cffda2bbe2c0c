// The lists of free slots, and each block's bricks and tiles in them.

#include "shared/octree.glsl"
#define NODE_BLOCKS_ACCESS coherent
#include "lib/kept_slots.glsl"

layout(std430) readonly buffer State { OctreeState octree_state; };
// Of each brick pool from its first slot on, and behind them all of the tiles.
layout(std430) buffer FreeSlots { uint free_slots[]; };

uint brick_slots() {
    return u_octree.slot_capacity.x + u_octree.slot_capacity.y + u_octree.slot_capacity.z;
}

int brick_pool(int level) {
    return level >= u_octree.leaf_level ? 2 : level >= u_octree.coarsest_leaf ? 1 : 0;
}

// A pool's share of a block: what is there now and was before, a bit each, and how many stand
// before the block.
struct SlotsOfBlock {
    int pool;
    uvec2 bits;
    uvec2 old;
    uint rank;
    uint old_rank;
    uint kept_rank;
};

SlotsOfBlock bricks_of_block(uint block, int level) {
    uint group = group_block(block / SCAN_BLOCKS);
    return SlotsOfBlock(brick_pool(level), block_bits(block), old_block_bits(block),
                        block_rank(block).x, old_block_rank(block).x,
                        kept_sums[block].x + kept_sums[group].x);
}

SlotsOfBlock tiles_of_block(uint block) {
    uint group = group_block(block / SCAN_BLOCKS);
    return SlotsOfBlock(TILE_POOL, used_bytes(block_bits(block)), used_bytes(old_block_bits(block)),
                        block_rank(block).y, old_block_rank(block).y,
                        kept_sums[block].y + kept_sums[group].y);
}

uint slot_word(int pool, uint rank) {
    return pool == TILE_POOL ? tile_slot_word(rank) : brick_slot_word(rank);
}

uint first_free_word(int pool) {
    return pool == TILE_POOL ? brick_slots() : octree_state.slot_pools[pool].first_slot;
}

// Takes the lowest bit out of a non-empty mask; returns its number.
uint take_lowest(inout uvec2 bits) {
    if (bits.x != 0u) {
        uint bit = uint(findLSB(bits.x));
        bits.x &= bits.x - 1u;
        return bit;
    }
    uint bit = 32u + uint(findLSB(bits.y));
    bits.y &= bits.y - 1u;
    return bit;
}

uint bits_before(uvec2 bits, uint bit) { return bit_count64(bits & bits_below(bit)); }
