// Where bricks' texels stand in the two atlases.
//
// Above the finest level a brick is 6 x 3x3x3 texels, radiance and cover of each side, and 3x3x3 of
// opacities along the axes. The six
// sides of a leaf follow from one radiance and one normal, so the finest level, with three quarters
// of the bricks, keeps just these: 3x3x3 texels in each of two atlases, a third of the memory.
// [Mittring12 "Generate directionally dependent voxel: at leaf level from voxel normal"]

#include "shared/octree.glsl"

uvec3 atlas_place(uint index, uint side_log2) {
    uint mask = (1u << side_log2) - 1u;
    return uvec3(index & mask, (index >> side_log2) & mask, index >> (2u * side_log2));
}

ivec3 brick_texel(uint brick) {
    uvec3 size = uvec3(BRICK_SIDE, BRICK_SIDE, BRICK_SIDE * BRICK_STACKS);
    return ivec3(atlas_place(brick, u_octree.atlas_side_log2) * size);
}

ivec3 leaf_texel(uint slot) {
    return ivec3(atlas_place(slot, u_octree.leaf_atlas_side_log2) * BRICK_SIDE);
}
