// Counting the bricks and tiles of 64-node blocks: for the prefix sums.

#include "shared/octree.glsl"
#define NODE_BLOCKS_ACCESS coherent
#include "lib/node_blocks.glsl"

void write_sums(uint block, uvec2 sums) {
    node_blocks[block * BLOCK_WORDS + 2u] = sums.x;
    node_blocks[block * BLOCK_WORDS + 3u] = sums.y;
}

uvec2 node_counts(uvec2 bits, int level) {
    uint tiles = level > u_octree.top_level ? bit_count64(used_bytes(bits)) : 0u;
    return uvec2(bit_count64(bits), tiles);
}
