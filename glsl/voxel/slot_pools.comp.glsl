// How many slots of each pool are kept, given back and taken, from the sums of a build and of the one
// before it. One thread. Where something does not fit, or did not last time, all slots are given out
// anew by rank, as in a first build: then too a build depends on the scene alone.
// [Mittring12 "Sparse Voxel Octree": fully maintained on GPU]

#include "lib/dispatch_args.glsl"
#include "lib/kept_slots.glsl"

layout(local_size_x = 1) in;

layout(std430) buffer State { OctreeState octree_state; };

// Of this build, of the last one, and kept: bricks (x) and tiles (y).
struct Ranks {
    uvec2 now;
    uvec2 old;
    uvec2 kept;
};

// Those before a level's first block.
Ranks before_level(int level) {
    uint block = min(grid_first_block(level), u_octree.block_count - 1u);
    Ranks r = Ranks(block_rank(block), old_block_rank(block),
                    kept_sums[block] + kept_sums[group_block(block / SCAN_BLOCKS)]);
    if (level <= u_octree.leaf_level) return r;
    uvec2 bits = block_bits(block);
    uvec2 old = old_block_bits(block);
    r.now += node_counts(bits, u_octree.leaf_level);
    r.old += node_counts(old, u_octree.leaf_level);
    r.kept += uvec2(bit_count64(bits & old), bit_count64(used_bytes(bits) & used_bytes(old)));
    return r;
}

void main() {
    bool overflows = octree_state.brick_dropped + octree_state.tile_dropped > 0u;
    bool fresh = overflows || octree_state.stale != 0u;
    octree_state.fresh = fresh ? 1u : 0u;
    octree_state.stale = overflows ? 1u : 0u;
    uint still = min(octree_state.still_count, u_octree.fragment_capacity);
    octree_state.relinked_fragments = dispatch_args(fresh ? still : 0u, FRAGMENT_GROUP);
    octree_state.relinked_voxels = dispatch_args(fresh ? u_octree.leaf_capacity * BRICK_VOXELS : 0u, BRICK_GROUP);

    int first_level[SLOT_POOLS] = int[SLOT_POOLS](0, u_octree.coarsest_leaf, u_octree.leaf_level, 0);
    int end_level[SLOT_POOLS] = int[SLOT_POOLS](u_octree.coarsest_leaf, u_octree.leaf_level,
                                               u_octree.leaf_level + 1, u_octree.leaf_level + 1);
    uint first_slot = 0u;
    for (int i = 0; i < SLOT_POOLS; ++i) {
        Ranks first = before_level(first_level[i]);
        Ranks end = before_level(end_level[i]);
        int kind = i == TILE_POOL ? 1 : 0;
        uint capacity = u_octree.slot_capacity[i];
        SlotPool pool = octree_state.slot_pools[i];
        pool.first_slot = i == TILE_POOL ? 0u : first_slot;
        pool.first_rank = first.now[kind];
        pool.first_old = first.old[kind];
        pool.first_kept = first.kept[kind];
        uint kept_ranks = i == TILE_POOL ? octree_state.tile_count : octree_state.brick_count;
        pool.used = clamp(kept_ranks, first.now[kind], end.now[kind]) - first.now[kind];
        if (fresh) {
            pool.free_count = capacity - pool.used;
        } else {
            uint kept = end.kept[kind] - first.kept[kind];
            pool.give_from = pool.free_count;
            pool.take_from = pool.free_count + (end.old[kind] - first.old[kind]) - kept;
            pool.free_count = pool.take_from - (pool.used - kept);
        }
        octree_state.slot_pools[i] = pool;
        first_slot += capacity;
    }
}
