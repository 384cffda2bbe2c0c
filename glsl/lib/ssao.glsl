// Angle-based ambient occlusion from a depth buffer. [Mittring12 "SSAO sampling"], [Sainz08]
#include "lib/math.glsl"

const int SSAO_PAIRS = 6;
const int SSAO_PATTERN = 4;  // pixels a side of the pattern of rotations

// The six pairs are offset and -offset: six directions over a half turn, 17/96 of it apart, lengths
// that fall by a constant ratio. Rotations over the half turn and scales over that ratio, 16 of
// each, give 96 pairs whose directions are all apart, in sixteens that are 1/16 apart for each
// length, and whose lengths are evenly spread in the logarithm: near and far corners count alike
// [inferred].
const float SSAO_RATIO = 0.7;
const vec2 SSAO_OFFSETS[6] = vec2[6](
    vec2(1.000000, 0.000000), vec2(0.594442, 0.369647), vec2(0.216721, 0.439468),
    vec2(-0.033620, 0.341348), vec2(-0.146164, 0.190484), vec2(-0.157298, 0.059203));

// Rotation and scale of a pixel of the 4x4 pattern, as (scale cos, scale sin). Multiplying by 7
// (odd) pairs each rotation with another of the 16 scales.
vec2 ssao_turn(ivec2 pixel) {
    ivec2 place = pixel & (SSAO_PATTERN - 1);
    int number = place.x + SSAO_PATTERN * ((place.y + 2 * (place.x & 1)) & (SSAO_PATTERN - 1));
    float angle = float(number) / 16.0 * PI;
    float scale = pow(SSAO_RATIO, (float((number * 7) & 15) + 0.5) / 16.0);
    return scale * vec2(cos(angle), sin(angle));
}

vec2 ssao_offset(int pair, vec2 turn) {
    vec2 o = SSAO_OFFSETS[pair];
    return vec2(o.x * turn.x - o.y * turn.y, o.x * turn.y + o.y * turn.x);
}

// What lies farther off than the radius is no part of the neighbourhood: it occludes ever less from
// 1.5 to 2.5 times the distance. A surface seen at 45 degrees, sqrt(2) radii away, counts in full.
const float SSAO_HALO = 2.5;  // radii

// Angle between a surface's normal and what a sample of the z buffer shows, over 90 degrees: the
// slide's angle_left / 90 or angle_right / 90, clamped against the tangent plane of the per-pixel
// normal. 1: nothing of the quarter turn is hidden.
float open_angle(vec3 to_sample, vec3 normal, float bias_m, float radius_m) {
    float distance_m = max(length(to_sample), 1e-6);
    float cosine = clamp((dot(to_sample, normal) - bias_m) / distance_m, 0.0, 1.0);
    float near = clamp(SSAO_HALO - distance_m / radius_m, 0.0, 1.0);
    return 1.0 - near * (1.0 - acos(cosine) / (0.5 * PI));
}

// The factor on indirect light. open: mean of (angle_left + angle_right) / 180.
float ssao_factor(float open, float power, float intensity) {
    return 1.0 - intensity * (1.0 - pow(clamp(open, 0.0, 1.0), power));
}
