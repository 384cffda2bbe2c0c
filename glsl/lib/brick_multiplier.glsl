// A brick's HDR multiplier. [Mittring12 "Compress": HDR multiplier, LDR colour]

#include "lib/voxel.glsl"

// Exponent of the smallest power of two that is no less than x, as a biased code of 8 bits.
uint scale_code(float x) {
    const float smallest = 1.0 / 1048576.0;
    int exponent;
    float mantissa = frexp(max(x, smallest), exponent);
    if (mantissa == 0.5) --exponent;
    return uint(clamp(exponent + NODE_SCALE_BIAS, 1, 255));
}

// The nodes, to write: of `brick` only the high bits change, so that other threads may descend
// meanwhile.
layout(std430) buffer ScaledNodes { Node scaled_nodes[]; };

// Notes the multiplier of a brick whose largest value is `maximum` in its node; returns its
// inverse.
float store_multiplier(uint brick, float maximum) {
    uint code = scale_code(maximum);
    scaled_nodes[bricks[brick].node & BRICK_NODE_MASK].brick = (brick + 1u)
        | (code << NODE_SCALE_SHIFT);
    return exp2(float(NODE_SCALE_BIAS) - float(code));
}

float largest(vec3 v) { return max(v.r, max(v.g, v.b)); }
