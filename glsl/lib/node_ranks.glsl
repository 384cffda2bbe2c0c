// The finished ranks: what scan_blocks and scan_groups leave behind.

#include "lib/node_counts.glsl"

layout(std430) readonly buffer Ranks { uvec2 ranks[]; };
layout(std430) readonly buffer GroupSums { uvec2 group_sums[]; };

// Bricks and tiles before the block.
uvec2 block_rank(uint block) { return ranks[block] + group_sums[block / SCAN_BLOCKS]; }
