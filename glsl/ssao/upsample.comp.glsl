// Edge-aware up-sampling: the mean of the 4x4 half-res texels around a pixel that lie on its
// surface, so that the pattern of rotations cancels. The factor multiplies the G-buffer's ambient
// occlusion. [Mittring12 "SSAO sampling": 16 rotations interleaved in 4x4 pattern]
#ifndef SHOW
#define SHOW 0  // 1: a picture of the factor instead
#endif

layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/packing.glsl"
#include "lib/ssao.glsl"
#include "lib/view.glsl"
#include "shared/gbuffer.glsl"
#include "shared/ssao.glsl"

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
uniform sampler2D u_half_z;
uniform sampler2D u_open;
#if SHOW
layout(rgba8) writeonly uniform image2D o_image;
#else
layout(rgba8) uniform image2D u_gbuffer_b;
#endif

// A texel counts while its distance from the pixel's tangent plane is below this share of its
// distance from the eye.
const float PLANE_TOLERANCE = 0.02;
// What any texel counts at least: a pixel without similar ones is filled.
const float LEAST_SIMILARITY = 1e-4;

float smooth_open(ivec2 pixel, float z) {
    vec3 n_vs = mat3(u_view.view_from_world)
        * normal10_decode(texelFetch(u_gbuffer_a, pixel, 0).xyz);
    vec2 ray_step = 2.0 * u_view.viewport_px.zw * u_ssao.view_ray;
    vec3 ray = vec3((vec2(pixel) + 0.5) * ray_step - u_ssao.view_ray, -1.0);
    float own_plane = z * dot(ray, n_vs);
    float inverse_tolerance = 1.0 / (PLANE_TOLERANCE * z);
    ivec2 first = pixel / 2 - 1;
    vec2 inverse_size = 1.0 / vec2(u_ssao.half_size);
    float sum = 0.0;
    float weights = 0.0;
    for (int quad = 0; quad < 4; ++quad) {
        ivec2 texel = first + 2 * ivec2(quad & 1, quad >> 1);
        vec2 uv = vec2(texel + 1) * inverse_size;
        // Of the quad's first texel, then how much one texel to the right and up adds.
        float along = dot(vec3((vec2(2 * texel) + 0.5) * ray_step - u_ssao.view_ray, -1.0), n_vs);
        vec2 more = 2.0 * ray_step * n_vs.xy;
        vec4 rays = along + vec4(more.y, more.x + more.y, more.x, 0.0);  // the order of a gather
        vec4 off_plane = abs(textureGather(u_half_z, uv) * rays - own_plane);
        vec4 weight = max(1.0 - off_plane * inverse_tolerance, LEAST_SIMILARITY);
        sum += dot(weight, textureGather(u_open, uv));
        weights += dot(weight, vec4(1.0));
    }
    return sum / weights;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    float depth = texelFetch(u_depth, pixel, 0).r;
    float factor = 1.0;
    if (depth != DEPTH_CLEAR) {
        float z = linear_depth(depth);
        float fade = clamp((u_ssao.fade_end - z) / max(u_ssao.fade_range, 1e-3), 0.0, 1.0);
        factor = ssao_factor(smooth_open(pixel, z), u_ssao.power, u_ssao.intensity * fade);
    }
#if SHOW
    imageStore(o_image, pixel, vec4(vec3(depth == DEPTH_CLEAR ? 0.0 : factor), 1.0));
#else
    if (factor == 1.0) return;
    vec4 b = imageLoad(u_gbuffer_b, pixel);
    imageStore(u_gbuffer_b, pixel, vec4(b.rgb, b.a * factor));
#endif
}
