// Streaks of the pixels around: those that lie before this one, those behind it that it leaves
// uncovered, and those that move along with it. [McGuire12 "A Reconstruction Filter for Plausible
// Motion Blur"]
#include "lib/finite.glsl"
#include "shared/motion_blur.glsl"

uniform sampler2D u_picture;
uniform sampler2D u_motion_px;
uniform sampler2D u_longest;

out vec4 o_color;

const int TAPS = 15;              // odd, the middle one is the pixel [McGuire12]
const float SHORTEST_PX = 0.5;    // half streaks that stay inside their pixel [McGuire12]
const float DEPTH_SOFTNESS = 0.02;  // share of the depth over which "before" fades [inferred]

float is_before(float a_m, float b_m) {
    return clamp(1.0 - (a_m - b_m) / (DEPTH_SOFTNESS * min(a_m, b_m)), 0.0, 1.0);
}
float cone(float distance, float streak) { return clamp(1.0 - distance / streak, 0.0, 1.0); }
float cylinder(float distance, float streak) {
    return 1.0 - smoothstep(0.95 * streak, 1.05 * streak, distance);
}

// -0.5..0.5, evenly spread over any 3x3 pixels. [Jimenez14 "Interleaved Gradient Noise"]
float jitter() {
    return fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
}

vec2 longest_around(ivec2 tile) {
    ivec2 last = textureSize(u_longest, 0) - 1;
    vec2 longest = vec2(0.0);
    for (int i = 0; i < 9; ++i) {
        ivec2 neighbour = clamp(tile + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
        vec2 streak = texelFetch(u_longest, neighbour, 0).xy;
        if (dot(streak, streak) > dot(longest, longest)) longest = streak;
    }
    return longest;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 color = texelFetch(u_picture, pixel, 0);
    o_color = color;
    vec2 along = longest_around(pixel / int(u_motion.tile));
    if (length(along) <= SHORTEST_PX) return;
    ivec2 last = textureSize(u_picture, 0) - 1;
    vec3 motion = texelFetch(u_motion_px, pixel, 0).xyz;
    float own = max(length(motion.xy), SHORTEST_PX);
    float weight = 1.0 / own;
    vec3 sum = weight * finite_radiance(color.rgb);
    float shift = jitter();
    for (int i = 0; i < TAPS; ++i) {
        if (i == TAPS / 2) continue;
        float t = 2.0 * (float(i + 1) + shift) / float(TAPS + 1) - 1.0;
        ivec2 tap = clamp(ivec2(floor(gl_FragCoord.xy + t * along)), ivec2(0), last);
        vec3 there = texelFetch(u_motion_px, tap, 0).xyz;
        float streak = max(length(there.xy), SHORTEST_PX);
        float distance = length(vec2(tap - pixel));
        float share = is_before(there.z, motion.z) * cone(distance, streak)
            + is_before(motion.z, there.z) * cone(distance, own)
            + 2.0 * cylinder(distance, streak) * cylinder(distance, own);
        weight += share;
        sum += share * finite_radiance(texelFetch(u_picture, tap, 0).rgb);
    }
    o_color.rgb = sum / weight;
}
