// From the occupied lattice points of a level: the nodes of that level that touch one, and the
// occupied points of the next coarser lattice. A node exists exactly where a lookup in it, border
// included, can differ from empty, so empty nodes can be skipped without a jump.
//
// DIRTY=1 starts from the dirty points alone: those of them that are occupied do as above, where the
// others have been done before; and all of them make the nodes dirty that touch one, and the coarser
// points.

#include "lib/dispatch.glsl"
#define NODE_BLOCKS_ACCESS coherent
#include "lib/node_blocks.glsl"
#include "lib/regions.glsl"
#include "shared/octree_level.glsl"
#ifndef DIRTY
#define DIRTY 0
#endif
#if DIRTY
#define DIRTY_ACCESS coherent
#include "lib/dirty.glsl"
#endif

layout(local_size_x = 64) in;

layout(std430) buffer Points { uint point_words[]; };

// Points of a 4x4x4 block by their coordinate along an axis, as masks over the block's Morton bits.
uvec2 odd_half(uint axis) {  // coordinate 1 or 3
    const uint mask[3] = uint[3](0xaaaaaaaau, 0xccccccccu, 0xf0f0f0f0u);
    return uvec2(mask[axis]);
}
uvec2 upper_half(uint axis) {  // coordinate 2 or 3
    if (axis == 2u) return uvec2(0u, 0xffffffffu);
    return uvec2(axis == 0u ? 0xff00ff00u : 0xffff0000u);
}
uvec2 lowest(uint axis) { return ~odd_half(axis) & ~upper_half(axis); }
uvec2 highest(uint axis) { return odd_half(axis) & upper_half(axis); }

// Node offset -1..1 from twice-coarser cell of the block: which points it touches (2n .. 2n + 2).
uvec2 points_of_node(uint axis, int offset) {
    return offset < 0 ? lowest(axis) : offset == 0 ? ~highest(axis) : upper_half(axis);
}
// Coarser point offset 0..2: which points its filter reaches (2q - 1 .. 2q + 1).
uvec2 points_of_coarser(uint axis, int offset) {
    return offset == 0 ? ~upper_half(axis) : offset == 1 ? ~lowest(axis) : highest(axis);
}

void set_node(ivec3 cell, int level) {
    uint code = grid_code(level, uvec3(cell));
    uint word = node_word(level, code);
    uint bit = cell_bit(code);
    if ((node_blocks[word] & bit) == 0u) atomicOr(node_blocks[word], bit);
}

void set_coarser_point(ivec3 point, int level) {
    uint code = grid_code(level, uvec3(point));
    uint word = cell_word(level, code);
    uint bit = cell_bit(code);
    if ((point_words[word] & bit) == 0u) atomicOr(point_words[word], bit);
}

#if DIRTY
void set_dirty(uint word, uint bit) {
    if ((dirty_words[word] & bit) == 0u) atomicOr(dirty_words[word], bit);
}

void set_dirty_node(ivec3 cell, int level) {
    uint code = grid_code(level, uvec3(cell));
    set_dirty(dirty_node_word(level, code), cell_bit(code));
}

void set_coarser_dirty(ivec3 point, int level) {
    uint code = grid_code(level, uvec3(point));
    set_dirty(cell_word(level, code), cell_bit(code));
}
#endif

void main() {
    int level = u_level.level;
    uint block = linear_thread_id();
    if (block >= grid_block_count(level + 1)) return;
    uint first_word = (grid_first_block(level + 1) + block) * 2u;
    uvec2 bits = uvec2(point_words[first_word], point_words[first_word + 1u]);
#if DIRTY
    uvec2 dirty = uvec2(dirty_words[first_word], dirty_words[first_word + 1u]);
    bits &= dirty;
    if (dirty == uvec2(0u)) return;
#else
    if (bits == uvec2(0u)) return;
#endif

    ivec3 base = ivec3(grid_cell(level + 1, block * 64u)) / 2;
    for (int i = 0; i < 27; ++i) {
        ivec3 offset = ivec3(i % 3, (i / 3) % 3, i / 9);
        ivec3 cell = base + offset - 1;
        ivec3 coarser = base + offset;
        uvec2 touched = points_of_node(0u, offset.x - 1) & points_of_node(1u, offset.y - 1)
                        & points_of_node(2u, offset.z - 1);
        uvec2 reached = points_of_coarser(0u, offset.x) & points_of_coarser(1u, offset.y)
                        & points_of_coarser(2u, offset.z);
#if DIRTY
        uvec2 asked = dirty;
#else
        uvec2 asked = bits;
#endif
        if ((touched & asked) != uvec2(0u) && in_grid(level, cell) && leaf_level_of_cell(cell, level) >= level) {
            if ((touched & bits) != uvec2(0u)) set_node(cell, level);
#if DIRTY
            set_dirty_node(cell, level);
#endif
        }
        // The lattice of level - 1 has as many points as this level has nodes.
        if (level > 0 && (reached & asked) != uvec2(0u) && in_grid(level, coarser)) {
            if ((reached & bits) != uvec2(0u)) set_coarser_point(coarser, level);
#if DIRTY
            set_coarser_dirty(coarser, level);
#endif
        }
    }
}
