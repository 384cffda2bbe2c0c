// Writes each brick's 6 x 3x3x3 texels: its own eight voxels and the redundant border, copied from
// the neighbours on its + sides, as RGBA8 under one power of two.
// [Mittring12 "Generate mip-maps, Create redundant border, Compress": HDR multiplier, LDR colour]
//
// Border and neighbour encode the same HDR value. A power of two keeps them equal to the bit where
// both bricks have the same multiplier, and rounding to nearest keeps the error of a voxel at or
// below 1/255 of its brick's largest value: half a step of at most twice that value.

#include "lib/sided_voxel.glsl"
#include "lib/brick_atlas.glsl"

layout(local_size_x = 64) in;

layout(std430) buffer NodeWords { Node node_words[]; };
layout(rgba8) writeonly uniform image3D u_atlas;

float largest(SidedVoxel v) {
    vec3 m = vec3(0.0);
    for (int i = 0; i < 6; ++i) m = max(m, v.side[i].rgb);
    return max(m.r, max(m.g, m.b));
}

// Exponent of the smallest power of two that is no less than x, as a biased code of 8 bits.
uint scale_code(float x) {
    const float smallest = 1.0 / 1048576.0;
    int exponent;
    float mantissa = frexp(max(x, smallest), exponent);
    if (mantissa == 0.5) --exponent;
    return uint(clamp(exponent + NODE_SCALE_BIAS, 1, 255));
}

void main() {
    uint brick = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * BRICK_GROUP;
    if (brick >= octree_state.brick_count) return;
    int level = unpack_cell_level(bricks[brick].cell);
    ivec3 cell = ivec3(unpack_cell(bricks[brick].cell));

    uint cell_brick[8];
    int cell_level[8];
    cell_brick[0] = brick;
    cell_level[0] = level;
    for (int i = 1; i < 8; ++i) {
        cell_brick[i] = brick_of_cell(cell + (ivec3(i, i >> 1, i >> 2) & 1), level, cell_level[i]);
    }

    float maximum = 0.0;
    for (uint i = 0u; i < 27u; ++i) {
        uvec3 texel = uvec3(i % 3u, (i / 3u) % 3u, i / 9u);
        uvec3 next = texel >> 1u;
        uint c = next.x | (next.y << 1) | (next.z << 2);
        if (cell_brick[c] == NO_BRICK) continue;
        maximum = max(maximum, largest(voxel_at(cell_brick[c], cell_level[c], uvec3(cell) * 2u + texel, level)));
    }
    uint code = scale_code(maximum);
    float inverse_scale = exp2(float(NODE_SCALE_BIAS) - float(code));
    uint node = bricks[brick].node;
    node_words[node].brick = (brick + 1u) | (code << NODE_SCALE_SHIFT);

    ivec3 base = brick_texel(brick);
    for (uint i = 0u; i < 27u; ++i) {
        uvec3 texel = uvec3(i % 3u, (i / 3u) % 3u, i / 9u);
        uvec3 next = texel >> 1u;
        uint c = next.x | (next.y << 1) | (next.z << 2);
        SidedVoxel v = voxel_at(cell_brick[c], cell_level[c], uvec3(cell) * 2u + texel, level);
        for (int side = 0; side < 6; ++side) {
            vec4 value = vec4(v.side[side].rgb * inverse_scale, v.side[side].a);
            imageStore(u_atlas, base + ivec3(texel) + ivec3(0, 0, side * int(BRICK_SIDE)), value);
        }
    }
}
