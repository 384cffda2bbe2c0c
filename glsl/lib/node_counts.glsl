// How many bricks and tiles a 64-node block asks for.

#include "shared/octree.glsl"
#include "lib/node_bits.glsl"

uvec2 node_counts(uvec2 bits, int level) {
    uint tiles = level > u_octree.top_level ? bit_count64(used_bytes(bits)) : 0u;
    return uvec2(bit_count64(bits), tiles);
}
