// Writing how many bricks and tiles stand before a 64-node block: for the prefix sums.

#include "shared/octree.glsl"
#define NODE_BLOCKS_ACCESS coherent
#include "lib/node_blocks.glsl"

void write_sums(uint block, uvec2 sums) {
    node_blocks[block * BLOCK_WORDS + 2u] = sums.x;
    node_blocks[block * BLOCK_WORDS + 3u] = sums.y;
}
