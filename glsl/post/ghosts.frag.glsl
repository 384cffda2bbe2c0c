// Reflections between the lens's surfaces: copies of the blurred bright light, larger or smaller
// and mirrored about the centre. [Mittring12 "Image Based Lens Flares": "Scale and mirror image
// multiple times; soft mask screen borders"]
#include "shared/lens_flare.glsl"
#include "lib/packing.glsl"

uniform sampler2D u_blurred;
uniform sampler2D u_target_like;

out vec4 o_light;

const vec3 BRIGHTEST = vec3(0.5 * HALF_MAX);  // leaves room for the bloom that it is added to
const float SOFT_BORDER = 0.15;  // share of the picture over which copies fade out [inferred]

float border_mask(vec2 uv) {
    vec2 inside = smoothstep(vec2(0.0), vec2(SOFT_BORDER), min(uv, 1.0 - uv));
    return inside.x * inside.y;
}

void main() {
    vec2 from_center = gl_FragCoord.xy / vec2(textureSize(u_target_like, 0)) - 0.5;
    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < FLARE_GHOSTS; ++k) {
        vec4 ghost = u_flare.ghosts[k];
        vec2 uv = from_center / ghost.a + 0.5;
        float mask = border_mask(uv);
        if (mask > 0.0) sum += mask * ghost.rgb * textureLod(u_blurred, uv, 0.0).rgb;
    }
    o_light = vec4(min(sum, BRIGHTEST), 0.0);
}
