// Sets the bit of every lattice point that a fragment fell on. MOVING=1: of the fragments behind those
// of what never moves, among the points of this build, of what moves, and of what has to be done anew.

#include "lib/fragment_queue.glsl"
#include "lib/node_bits.glsl"
#include "lib/regions.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer Fragments { VoxelFragment fragments[]; };
layout(std430) buffer Points { uint point_words[]; };
#if MOVING
layout(std430) buffer MovingPoints { uint moving_words[]; };
layout(std430) buffer Dirty { uint dirty_words[]; };
#endif

void main() {
    uint index = queue_index();
    if (!is_queued(index)) return;
    int level;
    uvec3 point = leaf_point(unpack_position(fragments[index].position), level);
    uint code = grid_code(level + 1, point);
    uint word = cell_word(level + 1, code);
    uint bit = cell_bit(code);
#if MOVING
    if ((moving_words[word] & bit) != 0u) return;
    atomicOr(moving_words[word], bit);
    atomicOr(dirty_words[word], bit);
#endif
    if ((point_words[word] & bit) == 0u) atomicOr(point_words[word], bit);
}
