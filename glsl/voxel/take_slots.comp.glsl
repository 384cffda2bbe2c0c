// What is new takes a free slot by its rank among the new ones: not by who comes first.

#include "lib/dispatch.glsl"
#include "lib/slot_pools.glsl"

layout(local_size_x = 64) in;

void take(SlotsOfBlock s) {
    SlotPool pool = octree_state.slot_pools[s.pool];
    for (uvec2 left = s.bits & ~s.old; left != uvec2(0u);) {
        uint bit = take_lowest(left);
        uint rank = s.rank + bits_before(s.bits, bit);
        uint kept_rank = s.kept_rank + bits_before(s.bits & s.old, bit);
        uint number = (rank - pool.first_rank) - (kept_rank - pool.first_kept);
        uint from = first_free_word(s.pool) + pool.take_from - 1u - number;
        node_blocks[slot_word(s.pool, rank)] = free_slots[from];
    }
}

void main() {
    uint block = linear_thread_id();
    if (block >= u_octree.block_count || octree_state.fresh != 0u) return;
    int level = grid_of_block(block);
    take(bricks_of_block(block, level));
    if (level > u_octree.top_level) take(tiles_of_block(block));
}
