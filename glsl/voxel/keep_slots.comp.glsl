// What was there before keeps its slot; what vanished gives its back, in the order of ranks. Where all
// slots are given out anew, a slot is a rank.

#include "lib/dispatch.glsl"
#include "lib/slot_pools.glsl"

layout(local_size_x = 64) in;

bool has_bit(uvec2 bits, uint bit) { return (((bit < 32u ? bits.x : bits.y) >> (bit & 31u)) & 1u) != 0u; }

void keep(SlotsOfBlock s) {
    SlotPool pool = octree_state.slot_pools[s.pool];
    bool fresh = octree_state.fresh != 0u;
    uint first_word = slot_word(s.pool, 0u);
    uint first_free = first_free_word(s.pool) + pool.give_from;
    for (uvec2 left = fresh ? s.bits : s.bits | s.old; left != uvec2(0u);) {
        uint bit = take_lowest(left);
        bool is = has_bit(s.bits, bit);
        bool was = has_bit(s.old, bit);
        if (fresh) {
            uint place = s.rank - pool.first_rank;
            if (place < pool.used) node_blocks[first_word + s.rank] = pool.first_slot + place;
        } else if (was) {
            uint slot = old_blocks[first_word + s.old_rank];
            uint vanished = (s.old_rank - pool.first_old) - (s.kept_rank - pool.first_kept);
            if (is) node_blocks[first_word + s.rank] = slot;
            else free_slots[first_free + vanished] = slot;
        }
        s.rank += uint(is);
        s.old_rank += uint(was);
        s.kept_rank += uint(is && was);
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
