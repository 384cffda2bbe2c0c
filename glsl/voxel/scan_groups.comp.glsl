// Prefix sum over 64-node blocks, second part: the groups' sums, the totals, and the arguments of
// every later indirect dispatch. One work group. KEEPS_SLOTS=1 also sums what was there before.

#include "lib/dispatch_args.glsl"
#include "lib/node_counts.glsl"
#include "lib/prefix_sum.glsl"
#ifndef KEEPS_SLOTS
#define KEEPS_SLOTS 0
#endif
#if KEEPS_SLOTS
#define KEPT_SUMS_ACCESS coherent
#include "lib/kept_slots.glsl"
#endif

layout(local_size_x = 256) in;

layout(std430) buffer State { OctreeState octree_state; };

// Bricks before the first block of a level's grid.
uint bricks_before_level(int level, uint total) {
    uint block = grid_first_block(level);
    return block < u_octree.block_count ? block_rank(block).x : total;
}

// Bricks before those of a tile's nodes: tiles and bricks stand in the same order.
uint bricks_before_tile(uint tile) {
    uint block = grid_first_block(u_octree.top_level + 1);
    uint end = u_octree.block_count;
    while (end - block > 1u) {
        uint middle = (block + end) / 2u;
        if (block_rank(middle).y <= tile) block = middle;
        else end = middle;
    }
    uvec2 bits = block_bits(block);
    uvec2 used = used_bytes(bits);
    uvec2 rank = block_rank(block);
    for (uint before = rank.y; before < tile; ++before) {
        if (used.x != 0u) used.x &= used.x - 1u;
        else used.y &= used.y - 1u;
    }
    uint first_bit = used.x != 0u ? uint(findLSB(used.x)) : 32u + uint(findLSB(used.y));
    return rank.x + bit_count64(bits & bits_below(first_bit));
}

uvec2 sum_of_group(uint group, bool kept) {
#if KEEPS_SLOTS
    if (kept) return kept_sums[group_block(group)];
#endif
    return block_sums(group_block(group));
}

void write_sum_of_group(uint group, bool kept, uvec2 sum) {
#if KEEPS_SLOTS
    if (kept) {
        kept_sums[group_block(group)] = sum;
        return;
    }
#endif
    write_sums(group_block(group), sum);
}

// Turns the groups' sums into those of the groups before them; scan_sums ends with the whole.
void sum_groups(uint thread, bool kept) {
    uint group_count = (u_octree.block_count + SCAN_BLOCKS - 1u) / SCAN_BLOCKS;
    uint a_thread = (group_count + SCAN_GROUP - 1u) / SCAN_GROUP;
    uint first = thread * a_thread;
    uvec2 total = uvec2(0u);
    for (uint i = first; i < min(first + a_thread, group_count); ++i) total += sum_of_group(i, kept);
    uvec2 through = group_inclusive_sum(thread, total);
    uvec2 before = through - total;
    for (uint i = first; i < min(first + a_thread, group_count); ++i) {
        uvec2 sum = sum_of_group(i, kept);
        write_sum_of_group(i, kept, before);
        before += sum;
    }
}

void main() {
    uint thread = gl_LocalInvocationID.x;
#if KEEPS_SLOTS
    sum_groups(thread, true);
    barrier();
#endif
    sum_groups(thread, false);
    memoryBarrierBuffer();
    barrier();
    if (thread != 0u) return;

    uvec2 all = scan_sums[SCAN_GROUP - 1u];
    int levels = u_octree.leaf_level + 1;
    // Bricks come coarsest level first, so a clipped pool loses leaves of the finest level.
    uint before_leaves = bricks_before_level(u_octree.coarsest_leaf, all.x);
    uint before_finest = bricks_before_level(u_octree.leaf_level, all.x);
    uint kept = min(all.x, u_octree.brick_capacity);
    if (kept > before_leaves && kept - before_leaves > u_octree.leaf_capacity) {
        kept = before_leaves + u_octree.leaf_capacity;
    }
    uint finest_capacity = max(u_octree.brick_capacity, u_octree.interior_capacity) - u_octree.interior_capacity;
    kept = min(kept, min(before_finest, u_octree.interior_capacity) + finest_capacity);
    if (before_finest > u_octree.interior_capacity) kept = min(kept, u_octree.interior_capacity);
    if (all.y > u_octree.tile_capacity) kept = min(kept, bricks_before_tile(u_octree.tile_capacity));
#if KEEPS_SLOTS
    uvec3 room = u_octree.slot_capacity.xyz;
    if (all.x - before_finest > room.z) kept = min(kept, before_finest + room.z);
    if (before_finest - before_leaves > room.y) kept = min(kept, before_leaves + room.y);
    if (before_leaves > room.x) kept = min(kept, room.x);
#endif
    octree_state.brick_count = kept;
    octree_state.brick_dropped = all.x - kept;
    octree_state.tile_count = min(all.y, u_octree.tile_capacity);
    octree_state.tile_dropped = all.y - octree_state.tile_count;
    octree_state.leaf_count = kept - min(before_leaves, kept);
    octree_state.interior_count = min(before_finest, kept);
    octree_state.leaf_asked = all.x - before_leaves;
    octree_state.interior_asked = before_finest;
#if KEEPS_SLOTS
    octree_state.first_leaf_brick = room.x;
    octree_state.first_finest_brick = room.x + room.y;
#else
    octree_state.first_leaf_brick = min(before_leaves, kept);
    octree_state.first_finest_brick = octree_state.interior_count;
#endif
    octree_state.interior_bricks = dispatch_args(octree_state.interior_count, BRICK_GROUP);
    octree_state.leaf_bricks = dispatch_args(kept - octree_state.interior_count, BRICK_GROUP);
    for (int level = 0; level <= levels; ++level) {
        octree_state.level_first[level] = min(bricks_before_level(level, all.x), kept);
    }
    // Counted by nodes.comp, completed by lists.comp.
    octree_state.leaf_voxels.threads = 0u;
    for (int level = 0; level < levels; ++level) octree_state.level_voxels[level].threads = 0u;
#if KEEPS_SLOTS
    octree_state.interior_bricks.threads = 0u;
    octree_state.leaf_bricks.threads = 0u;
#endif
}
