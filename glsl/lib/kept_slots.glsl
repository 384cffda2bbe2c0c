// The build before, beside this one's node blocks: which bricks and tiles keep their slots.

#include "lib/node_blocks.glsl"

// Node blocks with their sums and slots, as the last build left them.
layout(std430) readonly buffer OldBlocks { uint old_blocks[]; };
// For each block, and then for each group of blocks, bricks and tiles before it that were there in
// the last build and are in this: as the sums of node blocks.
#ifndef KEPT_SUMS_ACCESS
#define KEPT_SUMS_ACCESS readonly
#endif
layout(std430) KEPT_SUMS_ACCESS buffer KeptSums { uvec2 kept_sums[]; };

uvec2 old_block_bits(uint block) {
    return uvec2(old_blocks[block * BLOCK_WORDS], old_blocks[block * BLOCK_WORDS + 1u]);
}

uvec2 old_block_sums(uint block) {
    return uvec2(old_blocks[block * BLOCK_WORDS + 2u], old_blocks[block * BLOCK_WORDS + 3u]);
}

// Bricks and tiles of the last build before a block.
uvec2 old_block_rank(uint block) {
    return old_block_sums(block) + old_block_sums(group_block(block / SCAN_BLOCKS));
}
