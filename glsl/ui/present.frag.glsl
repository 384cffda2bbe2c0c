// Linear radiance on an sRGB display, clipped at 1: how the window shows views without a tone
// curve.
#include "lib/tonemap.glsl"

uniform sampler2D u_radiance;
in vec2 v_uv;
out vec4 o_color;

void main() {
    ivec2 size = textureSize(u_radiance, 0);
    vec3 radiance = texelFetch(u_radiance, min(ivec2(v_uv * vec2(size)), size - 1), 0).rgb;
    o_color = vec4(srgb_encode(radiance), 1.0);
}
