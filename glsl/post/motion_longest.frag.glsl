// The longest streak of each tile: first down its columns (AXIS 1), then along the row of what was
// found (0), so that no thread looks at more than a tile's side. [McGuire12 "A Reconstruction
// Filter for Plausible Motion Blur"]
#include "shared/motion_blur.glsl"

#ifndef AXIS
#define AXIS 0
#endif

uniform sampler2D u_motion_px;

out vec4 o_longest;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int tile = int(u_motion.tile);
    int first = texel[AXIS] * tile;
    int end = min(first + tile, textureSize(u_motion_px, 0)[AXIS]);
    vec2 longest = vec2(0.0);
    for (texel[AXIS] = first; texel[AXIS] < end; ++texel[AXIS]) {
        vec2 streak = texelFetch(u_motion_px, texel, 0).xy;
        if (dot(streak, streak) > dot(longest, longest)) longest = streak;
    }
    o_longest = vec4(longest, 0.0, 0.0);
}
