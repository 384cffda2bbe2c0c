// The light that blooms: exposed, and less the threshold. [Mittring12 "Bloom"]
#include "shared/bloom.glsl"
#include "lib/color.glsl"
#include "lib/packing.glsl"

uniform sampler2D u_picture;

flat in float v_exposure;
out vec4 o_color;

const float DARKEST = 1e-6;

void main() {
    vec3 exposed = v_exposure * texelFetch(u_picture, ivec2(gl_FragCoord.xy), 0).rgb;
    float share = clamp(1.0 - u_bloom.threshold / max(luminance(exposed), DARKEST), 0.0, 1.0);
    o_color = vec4(min(share * exposed, HALF_MAX), 1.0);
}
