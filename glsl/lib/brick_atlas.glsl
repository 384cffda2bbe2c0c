// Where a brick's texels stand in the atlas.

#include "shared/octree.glsl"

ivec3 brick_texel(uint brick) {
    uint log2_side = u_octree.atlas_side_log2;
    uint mask = (1u << log2_side) - 1u;
    uvec3 place = uvec3(brick & mask, (brick >> log2_side) & mask, brick >> (2u * log2_side));
    return ivec3(place * uvec3(BRICK_SIDE, BRICK_SIDE, BRICK_SIDE * BRICK_DIRECTIONS));
}
