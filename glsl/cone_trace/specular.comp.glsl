// One cone a listed pixel along the mirrored eye vector. [Mittring12 "Specular Sampling 1/2"]

#include "lib/dispatch.glsl"
#include "lib/specular_cone.glsl"
#include "shared/specular_list.glsl"

layout(local_size_x = 64) in;

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
uniform sampler2D u_gbuffer_d;
layout(rgba16f) writeonly uniform image2D o_specular_gi;

void main() {
    uint item = linear_thread_id();
    if (item >= specular_list.count) return;
    uint code = specular_list.pixels[item];
    ivec2 pixel = ivec2(code & 0xffffu, code >> 16);
    float depth = texelFetch(u_depth, pixel, 0).r;
    vec3 normal = normal10_decode(texelFetch(u_gbuffer_a, pixel, 0).xyz);
    vec3 p_ws = position_ws_at((vec2(pixel) + 0.5) * u_view.viewport_px.zw, depth);
    float half_angle = specular_cone_half_angle(specular_power_decode(texelFetch(u_gbuffer_d, pixel, 0).r));
    imageStore(o_specular_gi, pixel, specular_cone(p_ws, normal, half_angle));
}
