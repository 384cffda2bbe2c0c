// The longest streak in each tile. [McGuire12 "A Reconstruction Filter for Plausible Motion Blur"]
#include "shared/motion_blur.glsl"

uniform sampler2D u_motion_px;

out vec4 o_longest;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * int(u_motion.tile);
    ivec2 last = min(first + int(u_motion.tile), textureSize(u_motion_px, 0)) - 1;
    vec2 longest = vec2(0.0);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            vec2 streak = texelFetch(u_motion_px, ivec2(x, y), 0).xy;
            if (dot(streak, streak) > dot(longest, longest)) longest = streak;
        }
    }
    o_longest = vec4(longest, 0.0, 0.0);
}
