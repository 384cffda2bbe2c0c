// What has to be done anew: a bit a lattice point, as the occupied ones stand, then a bit a node.

#include "lib/node_bits.glsl"

#ifndef DIRTY_ACCESS
#define DIRTY_ACCESS readonly
#endif
layout(std430) DIRTY_ACCESS buffer Dirty { uint dirty_words[]; };

uint dirty_node_word(int level, uint code) {
    return grid_first_block(u_octree.leaf_level + 2) * 2u + cell_word(level, code);
}
