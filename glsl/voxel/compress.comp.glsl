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

// Exponent of the smallest power of two that is no less than x, as a biased code of 8 bits.
uint scale_code(float x) {
    const float smallest = 1.0 / 1048576.0;
    int exponent;
    float mantissa = frexp(max(x, smallest), exponent);
    if (mantissa == 0.5) --exponent;
    return uint(clamp(exponent + NODE_SCALE_BIAS, 1, 255));
}

float largest(vec3 v) { return max(v.r, max(v.g, v.b)); }

// The largest value of a voxel's sides. Some side of a leaf shows its radiance whole.
float largest_side(uint brick, uint voxel) {
    if ((bricks[brick].cell & BRICK_LEAF) != 0u) {
        return largest(unpack_half4(radiance[leaf_slot(brick) * BRICK_VOXELS + voxel]).rgb);
    }
    float maximum = 0.0;
    for (uint side = 0u; side < BRICK_DIRECTIONS; ++side) {
        maximum = max(maximum, largest(unpack_half4(sided[sided_index(brick, voxel, side)]).rgb));
    }
    return maximum;
}

// Which of a brick's 27 points stands in which of the 8 cells that the brick touches.
uint cell_of_texel(uvec3 texel) {
    uvec3 next = texel >> 1u;
    return next.x | (next.y << 1) | (next.z << 2);
}

void main() {
    uint brick = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * BRICK_GROUP;
    if (brick >= octree_state.brick_count) return;
    Brick place = bricks[brick];
    int level = unpack_cell_level(place.cell);
    uvec3 cell = unpack_cell(place.cell);

    uint cell_brick[8];
    int cell_level[8];
    uint cell_points[8];
    cell_brick[0] = brick;
    cell_level[0] = level;
    cell_points[0] = place.node >> BRICK_POINTS_SHIFT;
    for (int i = 1; i < 8; ++i) {
        cell_brick[i] = brick_of_cell(ivec3(cell) + (ivec3(i, i >> 1, i >> 2) & 1), level, cell_level[i]);
        cell_points[i] = points_of_cell(cell_brick[i], cell_level[i], level);
    }

    float maximum = 0.0;
    uint occupied = 0u;  // a bit for each of the 27 points that has anything to store
    for (uint i = 0u; i < 27u; ++i) {
        uvec3 texel = uvec3(i % 3u, (i / 3u) % 3u, i / 9u);
        uint c = cell_of_texel(texel);
        if ((cell_points[c] & (1u << voxel_of_point(texel))) == 0u) continue;
        occupied |= 1u << i;
        uvec3 point = (cell * 2u + texel) >> uint(level - cell_level[c]);
        maximum = max(maximum, largest_side(cell_brick[c], voxel_of_point(point)));
    }
    uint code = scale_code(maximum);
    float inverse_scale = exp2(float(NODE_SCALE_BIAS) - float(code));
    node_words[place.node & BRICK_NODE_MASK].brick = (brick + 1u) | (code << NODE_SCALE_SHIFT);

    // The atlas was cleared: points without anything stay as they are.
    ivec3 base = brick_texel(brick);
    while (occupied != 0u) {
        uint i = uint(findLSB(occupied));
        occupied &= occupied - 1u;
        uvec3 texel = uvec3(i % 3u, (i / 3u) % 3u, i / 9u);
        uint c = cell_of_texel(texel);
        for (uint axis = 0u; axis < 3u; ++axis) {
            AxisVoxel v = axis_voxel_at(cell_brick[c], cell_level[c], cell * 2u + texel, level, axis);
            ivec3 at = base + ivec3(texel) + ivec3(0, 0, axis * 2u * BRICK_SIDE);
            imageStore(u_atlas, at, vec4(v.plus_side.rgb * inverse_scale, v.plus_side.a));
            imageStore(u_atlas, at + ivec3(0, 0, BRICK_SIDE), vec4(v.minus_side.rgb * inverse_scale, v.minus_side.a));
        }
    }
}
