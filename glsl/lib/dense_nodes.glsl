// Levels up to the top level are arrays: a node's index is its level's start + its Morton code.

#include "lib/node_bits.glsl"

uint dense_node(int level, uvec3 cell) { return octal_sum(level) + morton_encode(cell); }

uint first_tile_node() { return octal_sum(u_octree.top_level + 1); }
