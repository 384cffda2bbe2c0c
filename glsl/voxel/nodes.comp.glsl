// Writes the nodes and the bricks' places: every word by one thread, from ranks alone; and lists what
// has to be lit, filtered and compressed: everything, or, with LISTS_DIRTY, what is dirty.
// [Mittring12 "Sparse Voxel Octree": fully maintained on GPU]

#include "lib/dispatch.glsl"
#include "lib/regions.glsl"
#include "lib/dense_nodes.glsl"
#include "lib/node_blocks.glsl"

#ifndef LISTS_DIRTY
#define LISTS_DIRTY 0
#endif
#if LISTS_DIRTY
#include "lib/dirty.glsl"
#include "shared/octree_step.glsl"
#endif

layout(local_size_x = 64) in;

layout(std430) readonly buffer Points { uint point_words[]; };
layout(std430) buffer State { OctreeState octree_state; };
layout(std430) writeonly buffer VoxelList { uint voxel_list[]; };  // see lib/voxel_list.glsl
layout(std430) buffer Nodes { Node nodes[]; };
layout(std430) writeonly buffer Bricks { Brick bricks[]; };

bool node_exists(int level, uvec3 cell) {
    if (!in_grid(level, ivec3(cell))) return false;
    uint code = grid_code(level, cell);
    return (node_blocks[node_word(level, code)] & cell_bit(code)) != 0u;
}

// Existence bits of a node's eight children, as a byte, and where that byte stands.
uint child_byte(int level, uvec3 cell, out uint block, out uint byte_start) {
    uvec3 first_child = cell * 2u;
    if (level >= u_octree.leaf_level || !in_grid(level + 1, ivec3(first_child))) return 0u;
    uint code = grid_code(level + 1, first_child);
    block = grid_first_block(level + 1) + (code >> 6);
    byte_start = code & 63u;
    return (node_blocks[node_word(level + 1, code)] >> (byte_start & 31u)) & 0xffu;
}

// Tile of the children + 1, 0 where there are none, their level is dense, or the pool is full.
uint tile_of_children(int level, uint byte, uint block, uint byte_start) {
    if (level < u_octree.top_level || byte == 0u) return 0u;
    uvec2 used = used_bytes(block_bits(block));
    uint tile = block_rank(block).y + bit_count64(used & bits_below(byte_start));
    return tile < octree_state.tile_count ? tile_of_rank(tile) + 1u : 0u;
}

// The largest empty ancestor of an empty node, the node itself included.
int empty_level(int level, uvec3 cell) {
    while (level > 0 && !node_exists(level - 1, cell >> 1u)) {
        --level;
        cell >>= 1u;
    }
    return level;
}

// Which of a node's own eight points are occupied, as a byte.
uint own_points(int level, uvec3 cell) {
    uvec3 first_point = cell * 2u;
    if (!in_grid(level + 1, ivec3(first_point))) return 0u;
    uint code = grid_code(level + 1, first_point);
    return (point_words[cell_word(level + 1, code)] >> (code & 31u)) & 0xffu;
}

#if LISTS_DIRTY
// Which of a node's own eight points, and whether its brick, are to be done anew.
uint dirty_points(int level, uvec3 cell) {
    if (u_step.everything != 0 || octree_state.fresh != 0u) return 0xffu;
    uvec3 first_point = cell * 2u;
    if (!in_grid(level + 1, ivec3(first_point))) return 0u;
    uint code = grid_code(level + 1, first_point);
    return (dirty_words[cell_word(level + 1, code)] >> (code & 31u)) & 0xffu;
}

void list_brick(uint brick, int level, uvec3 cell) {
    uint code = grid_code(level, cell);
    bool dirty = (dirty_words[dirty_node_word(level, code)] & cell_bit(code)) != 0u;
    if (!dirty && u_step.everything == 0 && octree_state.fresh == 0u) return;
    uint place = u_octree.brick_list;
    if (level == u_octree.leaf_level) place += u_octree.interior_capacity + atomicAdd(octree_state.leaf_bricks.threads, 1u);
    else place += atomicAdd(octree_state.interior_bricks.threads, 1u);
    voxel_list[place] = brick;
}
// Whether any of a block's nodes is dirty. Where none is, its nodes and tiles stay as they are: what
// they say changes with points of their own footprints alone, but for what dense nodes say of the
// emptiness above them.
bool block_is_dirty(uint block) {
    uint word = grid_first_block(u_octree.leaf_level + 2) * 2u + block * 2u;
    return u_step.everything != 0 || octree_state.fresh != 0u || (dirty_words[word] | dirty_words[word + 1u]) != 0u;
}
#else
uint dirty_points(int level, uvec3 cell) { return 0xffu; }
void list_brick(uint brick, int level, uvec3 cell) {}
bool block_is_dirty(uint block) { return true; }
#endif

// Lists voxels of a brick: a leaf's to be lit, others' to be filtered.
void list_voxels(uint brick, int level, bool leaf, uint points) {
    uint count = uint(bitCount(points));
    if (count == 0u) return;
    uint place;
    uint first_voxel;
    if (leaf) {
        place = u_octree.interior_capacity * BRICK_VOXELS + atomicAdd(octree_state.leaf_voxels.threads, count);
        first_voxel = (brick - octree_state.first_leaf_brick) * BRICK_VOXELS;
    } else {
        place = octree_state.level_first[level] * BRICK_VOXELS
                + atomicAdd(octree_state.level_voxels[level].threads, count);
        first_voxel = brick * BRICK_VOXELS;
    }
    for (; points != 0u; points &= points - 1u) {
        voxel_list[place] = first_voxel + uint(findLSB(points));
        ++place;
    }
}

// A brick that stays keeps its multiplier until it is compressed anew.
uint brick_word(uint index, uint brick) {
    uint old = nodes[index].brick;
    return (old & NODE_BRICK_MASK) == brick + 1u ? old : brick + 1u;
}

void write_node(uint index, int level, uvec3 cell, bool exists, uint rank) {
    Node node = Node(0u, 0u);
    if (exists && rank < octree_state.brick_count) {
        uint brick = brick_of_rank(rank);
        uint block, byte_start;
        uint byte = child_byte(level, cell, block, byte_start);
        bool leaf = level >= leaf_level_of_cell(ivec3(cell), level);
        bool hollow = byte == 0u && !leaf && level >= u_octree.top_level;
        node.child = hollow ? NODE_HOLLOW : tile_of_children(level, byte, block, byte_start);
        if (level == u_octree.leaf_level) node.child = brick - octree_state.first_finest_brick + 1u;
        node.brick = brick_word(index, brick);
        // Filtered points beside a coarser region hold what that lends them.
        bool lent = !leaf && u_octree.coarsest_leaf < u_octree.leaf_level;
        uint points = lent ? 0xffu : own_points(level, cell);
        list_voxels(brick, level, leaf, points & dirty_points(level, cell));
        list_brick(brick, level, cell);
        uint place = index | (points << BRICK_POINTS_SHIFT);
        bricks[brick] = Brick(pack_cell(cell, level, leaf), place);
    } else {
        node.child = uint(empty_level(level, cell));
    }
    nodes[index] = node;
}

void main() {
    uint block = linear_thread_id();
    if (block >= u_octree.block_count) return;
    int level = grid_of_block(block);
    uvec2 bits = block_bits(block);
    bool dense = level <= u_octree.top_level;
    if (!dense && (bits == uvec2(0u) || !block_is_dirty(block))) return;

    uvec2 rank = block_rank(block);
    uint first_code = (block - grid_first_block(level)) * 64u;
    uint node_count = min(64u, grid_side(level) * grid_side(level) * grid_side(level));
    uint tile = rank.y;
    uint index = 0u;
    for (uint i = 0u; i < node_count; ++i) {
        uint code = first_code + i;
        if (dense) {
            index = octal_sum(level) + code;
        } else if ((i & 7u) == 0u) {
            uint word = i < 32u ? bits.x : bits.y;
            if (((word >> (i & 31u)) & 0xffu) == 0u) {
                i += 7u;
                continue;
            }
            if (tile >= octree_state.tile_count) return;
            index = first_tile_node() + tile_of_rank(tile) * 8u;
            ++tile;
        }
        bool exists = ((i < 32u ? bits.x : bits.y) & (1u << (i & 31u))) != 0u;
        uint brick = rank.x + bit_count64(bits & bits_below(i));
        write_node(index, level, grid_cell(level, code), exists, brick);
        ++index;
    }
}
