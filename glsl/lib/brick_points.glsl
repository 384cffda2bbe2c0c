// The 27 points of a brick: its own eight and the redundant border, which its neighbours on the +
// sides own. [Mittring12 "Create redundant border"]

#include "lib/sided_voxel.glsl"

struct BrickPoints {
    uvec3 cell;
    int level;
    uint brick[8];   // of the cells that the points lie in, or NO_BRICK
    int reached[8];  // their levels: coarser than `level` beside a coarser region
    uint occupied;   // a bit for each point that holds anything
};

uvec3 texel_of_point(uint i) { return uvec3(i % 3u, (i / 3u) % 3u, i / 9u); }

// Which of the eight cells a point lies in.
uint cell_of_texel(uvec3 texel) {
    uvec3 next = texel >> 1u;
    return next.x | (next.y << 1) | (next.z << 2);
}

BrickPoints brick_points(uint brick) {
    Brick place = bricks[brick];
    BrickPoints p;
    p.level = unpack_cell_level(place.cell);
    p.cell = unpack_cell(place.cell);
    uint points[8];
    p.brick[0] = brick;
    p.reached[0] = p.level;
    points[0] = place.node >> BRICK_POINTS_SHIFT;
    for (int i = 1; i < 8; ++i) {
        p.brick[i] = brick_of_cell(ivec3(p.cell) + (ivec3(i, i >> 1, i >> 2) & 1), p.level, p.reached[i]);
        points[i] = points_of_cell(p.brick[i], p.reached[i], p.level);
    }
    p.occupied = 0u;
    for (uint i = 0u; i < 27u; ++i) {
        uvec3 texel = texel_of_point(i);
        if ((points[cell_of_texel(texel)] & (1u << voxel_of_point(texel))) != 0u) p.occupied |= 1u << i;
    }
    return p;
}

// The brick that owns a point, and which of its eight it is. A coarser neighbour region lends the
// nearest point that it has.
uint owner_of_point(BrickPoints p, uvec3 texel, out uint voxel) {
    uint c = cell_of_texel(texel);
    voxel = voxel_of_point((p.cell * 2u + texel) >> uint(p.level - p.reached[c]));
    return p.brick[c];
}

// Exponent of the smallest power of two that is no less than x, as a biased code of 8 bits.
uint scale_code(float x) {
    const float smallest = 1.0 / 1048576.0;
    int exponent;
    float mantissa = frexp(max(x, smallest), exponent);
    if (mantissa == 0.5) --exponent;
    return uint(clamp(exponent + NODE_SCALE_BIAS, 1, 255));
}

// The nodes once more, to write: of `brick` only the high bits change, so that other threads may
// descend meanwhile.
layout(std430) buffer NodeWords { Node node_words[]; };

// Notes the multiplier of a brick whose largest value is `maximum` in its node; returns its inverse.
float store_multiplier(uint brick, float maximum) {
    uint code = scale_code(maximum);
    node_words[bricks[brick].node & BRICK_NODE_MASK].brick = (brick + 1u) | (code << NODE_SCALE_SHIFT);
    return exp2(float(NODE_SCALE_BIAS) - float(code));
}

float largest(vec3 v) { return max(v.r, max(v.g, v.b)); }
