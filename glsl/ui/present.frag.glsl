// Linear radiance on an sRGB display, clipped at 1: how the window shows views without a tone curve.
#include "lib/tonemap.glsl"

uniform sampler2D u_radiance;
out vec4 o_color;

void main() {
    vec3 radiance = texelFetch(u_radiance, ivec2(gl_FragCoord.xy), 0).rgb;
    o_color = vec4(srgb_encode(radiance), 1.0);
}
