// What was there before keeps its slot; what vanished gives its back, in the order of ranks. Where all
// slots are given out anew, a slot is a rank.

#include "lib/dispatch.glsl"
#include "lib/slot_pools.glsl"

layout(local_size_x = 64) in;

void keep(SlotsOfBlock s) {
    SlotPool pool = octree_state.slot_pools[s.pool];
    bool fresh = octree_state.fresh != 0u;
    for (uvec2 left = fresh ? s.bits : s.bits | s.old; left != uvec2(0u);) {
        uint bit = take_lowest(left);
        uvec2 mask = bits_below(bit + 1u) & ~bits_below(bit);
        bool is = (s.bits & mask) != uvec2(0u);
        uint rank = s.rank + bits_before(s.bits, bit);
        if (fresh) {
            uint place = rank - pool.first_rank;
            if (place < pool.used) node_blocks[slot_word(s.pool, rank)] = pool.first_slot + place;
            continue;
        }
        if ((s.old & mask) == uvec2(0u)) continue;
        uint old_rank = s.old_rank + bits_before(s.old, bit);
        uint slot = old_blocks[slot_word(s.pool, old_rank)];
        if (is) {
            node_blocks[slot_word(s.pool, rank)] = slot;
        } else {
            uint kept_rank = s.kept_rank + bits_before(s.bits & s.old, bit);
            uint vanished = (old_rank - pool.first_old) - (kept_rank - pool.first_kept);
            free_slots[first_free_word(s.pool) + pool.give_from + vanished] = slot;
        }
    }
}

// A fresh list's place number `item`: the last one holds the lowest slot, which is taken first.
void fill_free(int number, uint item) {
    SlotPool pool = octree_state.slot_pools[number];
    if (item >= pool.free_count) return;
    uint capacity = u_octree.slot_capacity[number];
    free_slots[first_free_word(number) + item] = pool.first_slot + capacity - 1u - item;
}

void main() {
    uint item = linear_thread_id();
    if (octree_state.fresh != 0u) {
        for (int i = 0; i < SLOT_POOLS; ++i) fill_free(i, item);
    }
    if (item >= u_octree.block_count) return;
    int level = grid_of_block(item);
    keep(bricks_of_block(item, level));
    if (level > u_octree.top_level) keep(tiles_of_block(item));
}
