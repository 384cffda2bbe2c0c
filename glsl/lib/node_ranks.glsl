// The finished ranks: what scan_blocks and scan_groups leave behind.

#include "lib/node_counts.glsl"

layout(std430) readonly buffer Ranks { uvec2 ranks[]; };

// Bricks and tiles before the block.
uvec2 block_rank(uint block) { return ranks[block] + ranks[u_octree.block_count + block / SCAN_BLOCKS]; }
