// Recombines the nine sub-images: every pixel from the 5x5 around it, weighted by normal and depth.
// [Mittring12 "Diffuse Sampling 2/2" compositing pass]
//
// The 5x5 filter is the tent (3 - |x|)(3 - |y|): it gives each of the nine directions the same
// weight, so the 3x3 pattern cancels.
//
// AREA_LIGHTS adds the light of emissive parallelograms: at each pixel its closed form without shadow,
// times the filtered share of it that arrives. [Heitz18 "Combining analytic direct illumination and
// stochastic shadows"]

#ifndef AREA_LIGHTS
#define AREA_LIGHTS 0
#endif

#include "lib/cone_directions.glsl"
#include "lib/interleave.glsl"
#include "lib/packing.glsl"
#include "lib/view.glsl"
#include "lib/similar_surface.glsl"
#include "shared/gbuffer.glsl"
#if AREA_LIGHTS
#include "lib/area_light.glsl"
#include "lib/brdf.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_radiance;
uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
#if AREA_LIGHTS
uniform sampler2D u_area_irradiance;
uniform sampler2D u_gbuffer_d;
// What a broad lobe around the mirrored eye vector takes instead.
layout(rgba16f) writeonly uniform image2D o_broad_gi;
#endif
layout(rgba16f) writeonly uniform image2D o_diffuse_gi;

// A work group's pixels and the two around them on each side, read once.
const int REACH = 2;
const int TILE = 8 + 2 * REACH;
shared vec4 tile_position[TILE * TILE];  // world space, m; w: 1 on a surface, 0 where nothing is
shared vec3 tile_normal[TILE * TILE];
shared vec4 tile_radiance[TILE * TILE];
#if AREA_LIGHTS
shared vec4 tile_area[TILE * TILE];
#endif

void load_tile(ivec2 size) {
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * 8 - REACH;
    for (int i = int(gl_LocalInvocationIndex); i < TILE * TILE; i += 64) {
        ivec2 at = corner + ivec2(i % TILE, i / TILE);
        tile_position[i] = vec4(0.0);
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
        float depth = texelFetch(u_depth, at, 0).r;
        if (depth >= DEPTH_CLEAR) continue;
        vec2 uv = (vec2(at) + 0.5) * u_view.viewport_px.zw;
        tile_position[i] = vec4(position_ws_at(uv, depth), 1.0);
        tile_normal[i] = normal10_decode(texelFetch(u_gbuffer_a, at, 0).xyz);
        ivec2 texel = sub_image_texel(at, size);
        tile_radiance[i] = texelFetch(u_radiance, texel, 0);
#if AREA_LIGHTS
        tile_area[i] = texelFetch(u_area_irradiance, texel, 0);
#endif
    }
}

void main() {
    ivec2 size = ivec2(u_view.viewport_px.xy);
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    load_tile(size);
    barrier();
    if (any(greaterThanEqual(pixel, size))) return;
    ivec2 centre = ivec2(gl_LocalInvocationID.xy) + REACH;
    int own = centre.y * TILE + centre.x;
    if (tile_position[own].w == 0.0) {
        imageStore(o_diffuse_gi, pixel, vec4(0.0, 0.0, 0.0, 1.0));
#if AREA_LIGHTS
        imageStore(o_broad_gi, pixel, vec4(0.0, 0.0, 0.0, 1.0));
#endif
        return;
    }
    vec3 normal = tile_normal[own];
    vec3 p_ws = tile_position[own].xyz;
    float inverse_tolerance = inverse_plane_tolerance(p_ws);

#if AREA_LIGHTS
    vec4 from_area = vec4(0.0);
#endif
    // The pixels of one cone are three apart: of each axis' five, one or two.
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int residue = 0; residue < CONE_COUNT; ++residue) {
        ivec2 first = ivec2(residue % 3, residue / 3) - REACH;
        vec4 cone_sum = vec4(0.0);
        float cone_samples = 0.0;
        for (int y = first.y; y <= REACH; y += 3) {
            for (int x = first.x; x <= REACH; x += 3) {
                int neighbour = own + y * TILE + x;
                vec4 position = tile_position[neighbour];
                if (position.w == 0.0) continue;
                float similarity = plane_similarity(position.xyz, p_ws, normal, inverse_tolerance);
                similarity *= normal_similarity(tile_normal[neighbour], normal);
                float tent = float((3 - abs(x)) * (3 - abs(y)));
                float weight = tent * max(similarity, LEAST_SIMILARITY);
#if AREA_LIGHTS
                from_area += weight * tile_area[neighbour];
#endif
                vec4 traced = tile_radiance[neighbour];
                if (traced.a < 0.0) continue;  // rejected
                cone_sum += traced * weight;
                cone_samples += weight;
            }
        }
        // Each cone's mean first, so that a cone with fewer similar neighbours keeps its weight.
        if (cone_samples <= 0.0) continue;
        float weight = cone_group_weight(normal, cone_of_pixel(pixel + first + 3));
        sum += cone_sum * (weight / cone_samples);
        weights += weight;
    }
    vec4 gathered = sum / max(weights, 1e-6);
#if AREA_LIGHTS
    vec4 broad = gathered;
    if (from_area.a > 0.0) {
        float diffuse = luminance(area_irradiance(p_ws, normal)) * INVERSE_PI;
        gathered.rgb += from_area.rgb * (diffuse / from_area.a);
        float power = specular_power_decode(texelFetch(u_gbuffer_d, pixel, 0).r);
        float half_angle = specular_cone_half_angle(power);
        vec3 mirrored = reflect(normalize(p_ws - u_view.eye_ws), normal);
        float visible = luminance(from_area.rgb) / from_area.a;
        broad.rgb += visible * area_lobe_radiance(p_ws, normal, mirrored, half_angle);
    }
    imageStore(o_broad_gi, pixel, min(broad, HALF_MAX));
#endif
    imageStore(o_diffuse_gi, pixel, min(gathered, HALF_MAX));
}
