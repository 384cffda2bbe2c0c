// Scattering of circles of confusion, gathered: a tap counts where its own circle reaches, by the
// inverse of the circle's area. What lies before the focus is kept apart, for it spreads over what
// is sharp. [Jimenez14 "Next Generation Post Processing in Call of Duty: Advanced Warfare"]
#include "lib/math.glsl"
#include "lib/focus.glsl"

uniform sampler2D u_prepared;

layout(location = 0) out vec4 o_far;   // radiance; a: whether there is any
layout(location = 1) out vec4 o_near;  // radiance times coverage, coverage

const float MOST_RINGS = 8.0;  // of 6 k taps each, so that each tap stands for the same area

void main() {
    ivec2 last = textureSize(u_prepared, 0) - 1;
    float reach = max(0.5 * u_focus.largest_px, 1.0);
    float rings = min(ceil(reach), MOST_RINGS);
    float spacing = reach / (rings + 0.5);
    float tap_area = PI * reach * reach / (1.0 + 3.0 * rings * (rings + 1.0));
    vec4 far = vec4(0.0);
    vec4 near = vec4(0.0);
    for (int ring = 0; ring <= int(rings); ++ring) {
        int taps = max(6 * ring, 1);
        for (int k = 0; k < taps; ++k) {
            float angle = 2.0 * PI * (float(k) + 0.5 * float(ring & 1)) / float(taps);
            vec2 offset = spacing * float(ring) * vec2(cos(angle), sin(angle));
            ivec2 place = ivec2(floor(gl_FragCoord.xy + offset));
            // Circles don't mix.
            vec4 tap = texelFetch(u_prepared, clamp(place, ivec2(0), last), 0);
            float distance = length(vec2(place) + 0.5 - gl_FragCoord.xy);
            float radius = abs(tap.a);
            float covers = clamp(radius - distance + 0.5, 0.0, 1.0);
            float weight = covers / (PI * max(radius * radius, tap_area / PI));
            if (tap.a > 0.0) far += weight * vec4(tap.rgb, 1.0);
            if (tap.a < -0.5 * SHARP_PX) near += weight * vec4(tap.rgb, 1.0);
        }
    }
    o_far = far.a > 0.0 ? vec4(far.rgb / far.a, 1.0) : vec4(0.0);
    float coverage = clamp(near.a * tap_area, 0.0, 1.0);
    o_near = near.a > 0.0 ? vec4(near.rgb / near.a * coverage, coverage) : vec4(0.0);
}
