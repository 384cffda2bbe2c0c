// Writes the nodes and the bricks' places: every word by one thread, from ranks alone.
// [Mittring12 "Sparse Voxel Octree": fully maintained on GPU]

#include "lib/lattice.glsl"
#include "lib/node_ranks.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer NodeBits { uint node_words[]; };
layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) writeonly buffer Nodes { Node nodes[]; };
layout(std430) writeonly buffer Bricks { Brick bricks[]; };

bool node_exists(int level, uint code) {
    return (node_words[cell_word(level, code)] & cell_bit(code)) != 0u;
}

// Tile of the node's children + 1, 0 where it has none or the pool is full.
uint tile_of_children(int level, uint code) {
    if (level < u_octree.top_level || level >= u_octree.leaf_level) return 0u;
    uint block = grid_first_block(level + 1) + (code >> 3);
    uvec2 bits = uvec2(node_words[block * 2u], node_words[block * 2u + 1u]);
    uint byte_start = (code & 7u) * 8u;
    uvec2 used = used_bytes(bits);
    uvec2 siblings = bits_below(byte_start + 8u) & ~bits_below(byte_start);
    if ((bits & siblings) == uvec2(0u)) return 0u;
    uint tile = block_rank(block).y + bit_count64(used & bits_below(byte_start));
    return tile < octree_state.tile_count ? tile + 1u : 0u;
}

bool has_children(int level, uint code) {
    if (level >= u_octree.leaf_level) return false;
    uint word = node_words[cell_word(level + 1, code << 3)];
    return ((word >> ((code & 3u) * 8u)) & 0xffu) != 0u;
}

// The largest empty ancestor of an empty node, the node itself included.
int empty_level(int level, uint code) {
    while (level > 0 && !node_exists(level - 1, code >> 3)) {
        --level;
        code >>= 3;
    }
    return level;
}

uint dense_start(int level) { return ((1u << (3 * level)) - 1u) / 7u; }

void write_node(uint index, int level, uint code, bool exists, uint brick) {
    Node node = Node(0u, 0u);
    if (exists && brick < octree_state.brick_count) {
        node.child = tile_of_children(level, code);
        node.brick = brick + 1u;
        bricks[brick] = Brick(pack_cell(morton_decode(code), level, !has_children(level, code)), index);
    } else {
        node.child = uint(empty_level(level, code));
    }
    nodes[index] = node;
}

void main() {
    uint block = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
    if (block >= u_octree.block_count) return;
    int level = grid_of_block(block);
    uvec2 bits = uvec2(node_words[block * 2u], node_words[block * 2u + 1u]);
    bool dense = level <= u_octree.top_level;
    if (!dense && bits == uvec2(0u)) return;

    uvec2 rank = block_rank(block);
    uint first_code = (block - grid_first_block(level)) * 64u;
    uint node_count = min(64u, 1u << (3 * level));
    uint tile = rank.y;
    uint index = 0u;
    for (uint i = 0u; i < node_count; ++i) {
        uint code = first_code + i;
        if (dense) {
            index = dense_start(level) + code;
        } else if ((i & 7u) == 0u) {
            uint word = i < 32u ? bits.x : bits.y;
            if (((word >> (i & 31u)) & 0xffu) == 0u) {
                i += 7u;
                continue;
            }
            if (tile >= octree_state.tile_count) return;
            index = dense_start(u_octree.top_level + 1) + tile * 8u;
            ++tile;
        }
        bool exists = ((i < 32u ? bits.x : bits.y) & (1u << (i & 31u))) != 0u;
        uint brick = rank.x + bit_count64(bits & bits_below(i));
        write_node(index, level, code, exists, brick);
        ++index;
    }
}
