// Recombines the nine sub-images: every pixel from the 5x5 around it, weighted by normal and depth.
// [Mittring12 "Diffuse Sampling 2/2" compositing pass]
//
// The 5x5 filter is the tent (3 - |x|)(3 - |y|): it gives each of the nine directions the same
// weight, so the 3x3 pattern cancels.

#include "lib/cone_directions.glsl"
#include "lib/interleave.glsl"
#include "lib/packing.glsl"
#include "lib/view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_radiance;
uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
layout(rgba16f) writeonly uniform image2D o_diffuse_gi;

// A neighbour counts while its distance from the pixel's tangent plane is below this share of its
// distance from the eye...
const float PLANE_TOLERANCE = 0.01;
// ... and by the cosine between the normals to this power.
const float NORMAL_POWER = 8.0;

void main() {
    ivec2 size = ivec2(u_view.viewport_px.xy);
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size))) return;
    float depth = texelFetch(u_depth, pixel, 0).r;
    if (depth >= 1.0) {
        imageStore(o_diffuse_gi, pixel, vec4(0.0, 0.0, 0.0, 1.0));
        return;
    }
    vec3 normal = normal10_decode(texelFetch(u_gbuffer_a, pixel, 0).xyz);
    vec3 p_ws = position_ws_at((vec2(pixel) + 0.5) * u_view.viewport_px.zw, depth);
    float inverse_tolerance = 1.0 / (PLANE_TOLERANCE * distance(p_ws, u_view.eye_ws));

    vec4 cone_sum[CONE_COUNT];
    float cone_samples[CONE_COUNT];
    for (int i = 0; i < CONE_COUNT; ++i) {
        cone_sum[i] = vec4(0.0);
        cone_samples[i] = 0.0;
    }
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            ivec2 at = pixel + ivec2(x, y);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
            vec4 traced = texelFetch(u_radiance, sub_image_texel(at, size), 0);
            vec3 neighbour = position_ws_at((vec2(at) + 0.5) * u_view.viewport_px.zw, texelFetch(u_depth, at, 0).r);
            vec3 neighbour_normal = normal10_decode(texelFetch(u_gbuffer_a, at, 0).xyz);
            float off_plane = abs(dot(neighbour - p_ws, normal)) * inverse_tolerance;
            float weight = float((3 - abs(x)) * (3 - abs(y))) * max(1.0 - off_plane, 0.0)
                           * pow(max(dot(normal, neighbour_normal), 0.0), NORMAL_POWER);
            int cone = cone_of_pixel(at);
            cone_sum[cone] += traced * weight;
            cone_samples[cone] += weight;
        }
    }
    // Each cone's mean first, so that a cone with fewer accepted samples keeps its weight.
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < CONE_COUNT; ++i) {
        if (cone_samples[i] <= 0.0) continue;
        sum += cone_sum[i] / cone_samples[i];
        weights += cone_group_weight(normal, i);
    }
    imageStore(o_diffuse_gi, pixel, sum / max(weights, 1e-6));
}
