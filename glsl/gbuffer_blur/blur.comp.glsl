// Smart blur of normal and ambient occlusion over five pixels, and the specular power that the
// spread of the normals asks for. Depth and AO come in two gathers, which hold the cross of five.
// [Mittring12 "G-buffer Blur"]
layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/gbuffer_blur.glsl"
#include "lib/brdf.glsl"
#include "lib/packing.glsl"
#include "lib/view.glsl"
#include "shared/gbuffer.glsl"

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
uniform sampler2D u_gbuffer_b;
uniform sampler2D u_gbuffer_d;
layout(rgb10_a2) writeonly uniform image2D o_a;
layout(rgba8) writeonly uniform image2D o_b;
layout(rgba8) writeonly uniform image2D o_d;

vec3 normal_at(ivec2 pixel) {
    ivec2 inside = clamp(pixel, ivec2(0), ivec2(u_view.viewport_px.xy) - 1);
    return normal10_decode(texelFetch(u_gbuffer_a, inside, 0).xyz);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    vec4 a = texelFetch(u_gbuffer_a, pixel, 0);
    vec4 b = texelFetch(u_gbuffer_b, pixel, 0);
    vec4 d = texelFetch(u_gbuffer_d, pixel, 0);
    // A gather at a pixel's corner holds, from its x on: upper left, upper right, lower right,
    // lower left.
    vec2 low = vec2(pixel) * u_view.viewport_px.zw;
    vec2 high = vec2(pixel + 1) * u_view.viewport_px.zw;
    vec4 low_depth = textureGather(u_depth, low);
    float depth = low_depth.y;
    if (depth != DEPTH_CLEAR) {
        // Left, right, below, above.
        vec4 depths = vec4(low_depth.x, textureGather(u_depth, high).zx, low_depth.z).xywz;
        vec4 low_ao = textureGather(u_gbuffer_b, low, 3);
        vec4 ao = vec4(low_ao.x, textureGather(u_gbuffer_b, high, 3).zx, low_ao.z).xywz;
        vec3 normal = normal10_decode(a.xyz);
        vec3 n_vs = mat3(u_view.view_from_world) * normal;
        vec2 pixel_ray = 2.0 * u_view.viewport_px.zw * view_ray();
        vec3 ray = vec3((vec2(pixel) + 0.5) * pixel_ray - view_ray(), -1.0);
        float z = linear_depths(vec4(depth)).x;
        vec4 along = dot(ray, n_vs) + vec4(vec2(-1.0, 1.0) * pixel_ray.x * n_vs.x,
                                           vec2(-1.0, 1.0) * pixel_ray.y * n_vs.y);
        vec4 off_plane = abs(linear_depths(depths) * along - z * dot(ray, n_vs))
            / (z * pixel_ray.y);
        vec3 sum = normal;
        float open = low_ao.y;
        float weights = 1.0;
        const ivec2 NEIGHBOURS[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
        for (int i = 0; i < 4; ++i) {
            vec3 other = normal_at(pixel + NEIGHBOURS[i]);
            float weight = blur_weight(normal, other, off_plane[i]);
            sum += weight * other;
            open += weight * ao[i];
            weights += weight;
        }
        float power = toksvig_power(specular_power_decode(d.r), length(sum) / weights);
        a.xyz = normal10_encode(normalize(sum));
        b.a = open / weights;
        d.r = specular_power_encode(max(power, SPECULAR_POWER_MIN));
    }
    imageStore(o_a, pixel, a);
    imageStore(o_b, pixel, b);
    imageStore(o_d, pixel, d);
}
