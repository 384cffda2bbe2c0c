// Six pairs of samples into the half-res z buffer: the mean of (angle_left + angle_right) / 180.
// [Mittring12 "SSAO sampling"]
layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/packing.glsl"
#include "lib/ssao.glsl"
#include "shared/ssao.glsl"
#include "shared/view.glsl"

uniform sampler2D u_half_z;
uniform sampler2D u_gbuffer_a;
layout(r8) writeonly uniform image2D o_open;

// Largest radius as a share of the picture's height: farther samples would be too far apart to find
// what lies between them [inferred].
const float RADIUS_MAX = 0.25;

vec3 position_vs(ivec2 texel, float z) {
    vec2 clip = (vec2(2 * texel) + 0.5) * u_view.viewport_px.zw * 2.0 - 1.0;
    return vec3(clip * u_ssao.view_ray, -1.0) * z;
}

float open_share(ivec2 texel, float z) {
    vec3 p = position_vs(texel, z);
    vec3 n_ws = normal10_decode(texelFetch(u_gbuffer_a, 2 * texel, 0).xyz);
    vec3 normal = mat3(u_view.view_from_world) * n_ws;
    float height = float(u_ssao.half_size.y);
    float texels_an_m = height / (2.0 * u_ssao.view_ray.y * z);
    float radius = min(u_ssao.radius * texels_an_m, RADIUS_MAX * height);
    float radius_m = radius / texels_an_m;
    vec2 turn = radius * ssao_turn(texel);
    float sum = 0.0;
    float samples = 0.0;
    for (int pair = 0; pair < SSAO_PAIRS; ++pair) {
        ivec2 offset = ivec2(round(ssao_offset(pair, turn)));
        if (offset == ivec2(0)) continue;
        for (int side = -1; side <= 1; side += 2) {
            ivec2 at = texel + side * offset;
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, u_ssao.half_size)))
                continue;
            float sample_z = texelFetch(u_half_z, at, 0).r;
            vec3 to_sample = position_vs(at, sample_z) - p;
            sum += sample_z > 0.0 ? open_angle(to_sample, normal, u_ssao.bias, radius_m) : 1.0;
            samples += 1.0;
        }
    }
    return samples > 0.0 ? sum / samples : 1.0;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, u_ssao.half_size))) return;
    float z = texelFetch(u_half_z, texel, 0).r;
    bool counts = z > 0.0 && z < u_ssao.fade_end;
    imageStore(o_open, texel, vec4(counts ? open_share(texel, z) : 1.0));
}
