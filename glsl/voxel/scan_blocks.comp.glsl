// Prefix sum over 64-node blocks, first part: ranks inside groups of SCAN_BLOCKS blocks.
// x counts bricks (existing nodes), y tiles (sibling groups below the dense levels). KEEPS_SLOTS=1
// counts those that were there before, too.

#include "lib/node_counts.glsl"
#ifndef KEEPS_SLOTS
#define KEEPS_SLOTS 0
#endif
#if KEEPS_SLOTS
#define KEPT_SUMS_ACCESS writeonly
#include "lib/kept_slots.glsl"
#endif
#include "lib/prefix_sum.glsl"

layout(local_size_x = 256) in;

// Bricks and tiles of a block; `kept`: only those that were there before.
uvec2 counts_of_block(uint block, bool kept) {
    if (block >= u_octree.block_count) return uvec2(0u);
    int level = grid_of_block(block);
    uvec2 bits = block_bits(block);
    uvec2 counts = node_counts(bits, level);
#if KEEPS_SLOTS
    if (kept) {
        uvec2 old = old_block_bits(block);
        counts.x = bit_count64(bits & old);
        if (level > u_octree.top_level) counts.y = bit_count64(used_bytes(bits) & used_bytes(old));
    }
#endif
    return counts;
}

void sum_blocks(bool kept) {
    const uint blocks_a_thread = SCAN_BLOCKS / SCAN_GROUP;
    uint thread = gl_LocalInvocationID.x;
    uint first = gl_WorkGroupID.x * SCAN_BLOCKS + thread * blocks_a_thread;
    uvec2 counts[blocks_a_thread];
    uvec2 total = uvec2(0u);
    for (uint i = 0u; i < blocks_a_thread; ++i) {
        counts[i] = total;
        total += counts_of_block(first + i, kept);
    }
    uvec2 through = group_inclusive_sum(thread, total);
    uvec2 before = through - total;
    for (uint i = 0u; i < blocks_a_thread; ++i) {
        if (first + i >= u_octree.block_count) break;
#if KEEPS_SLOTS
        if (kept) {
            kept_sums[first + i] = before + counts[i];
            continue;
        }
#endif
        write_sums(first + i, before + counts[i]);
    }
    if (thread != SCAN_GROUP - 1u) return;
#if KEEPS_SLOTS
    if (kept) {
        kept_sums[group_block(gl_WorkGroupID.x)] = through;
        return;
    }
#endif
    write_sums(group_block(gl_WorkGroupID.x), through);
}

void main() {
    sum_blocks(false);
#if KEEPS_SLOTS
    barrier();
    sum_blocks(true);
#endif
}
