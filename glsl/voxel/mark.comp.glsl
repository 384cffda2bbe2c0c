// Sets the bit of every lattice point that a fragment fell on.

#include "lib/dispatch.glsl"
#include "lib/node_bits.glsl"
#include "lib/regions.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) readonly buffer Fragments { VoxelFragment fragments[]; };
layout(std430) buffer Points { uint point_words[]; };

void main() {
    uint index = linear_thread_id();
    if (index >= min(octree_state.fragment_count, u_octree.fragment_capacity)) return;
    int level;
    uvec3 point = leaf_point(unpack_position(fragments[index].position), level);
    uint code = grid_code(level + 1, point);
    uint word = cell_word(level + 1, code);
    uint bit = cell_bit(code);
    if ((point_words[word] & bit) == 0u) atomicOr(point_words[word], bit);
}
