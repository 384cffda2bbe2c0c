// Prefix sum over 64-node blocks, first part: ranks inside groups of SCAN_BLOCKS blocks.
// x counts bricks (existing nodes), y tiles (sibling groups below the dense levels).

#include "lib/node_counts.glsl"
#include "lib/prefix_sum.glsl"

layout(local_size_x = 256) in;

void main() {
    const uint blocks_a_thread = SCAN_BLOCKS / SCAN_GROUP;
    uint thread = gl_LocalInvocationID.x;
    uint first = gl_WorkGroupID.x * SCAN_BLOCKS + thread * blocks_a_thread;
    uvec2 counts[blocks_a_thread];
    uvec2 total = uvec2(0u);
    for (uint i = 0u; i < blocks_a_thread; ++i) {
        uint block = first + i;
        counts[i] = total;
        if (block >= u_octree.block_count) continue;
        total += node_counts(block_bits(block), grid_of_block(block));
    }
    uvec2 through = group_inclusive_sum(thread, total);
    uvec2 before = through - total;
    for (uint i = 0u; i < blocks_a_thread; ++i) {
        if (first + i < u_octree.block_count) write_sums(first + i, before + counts[i]);
    }
    if (thread == SCAN_GROUP - 1u) write_sums(group_block(gl_WorkGroupID.x), through);
}
