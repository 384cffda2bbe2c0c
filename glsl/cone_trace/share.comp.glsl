// Where pixels share 36 cones: of each pixel's group the mean over its four, which it and the pixels
// around it in the group's sub-image traced. Beyond [Mittring12], whose nine cones are 39 degrees wide.
//
// Neighbours in a sub-image stand three pixels apart, each in the next 3x3 pattern: of the 3x3 around a
// pixel the middle traced its own cone, two beside it a second one, two above and below a third, and the
// corners the fourth. Each cone's mean comes first, so that one with fewer similar neighbours keeps its
// weight.

#include "lib/cone_directions.glsl"
#include "lib/interleave.glsl"
#include "lib/packing.glsl"
#include "lib/view.glsl"
#include "lib/similar_surface.glsl"
#include "shared/gbuffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_parts;
uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
layout(rgba16f) writeonly uniform image2D o_radiance;

const int TILE = 8 + 2;
shared vec4 tile_position[TILE * TILE];  // world space, m; w: 1 on a surface, 0 where nothing is
shared vec4 tile_radiance[TILE * TILE];

void load_tile(ivec2 size, int cone) {
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * 8 - 1;
    for (int i = int(gl_LocalInvocationIndex); i < TILE * TILE; i += 64) {
        ivec2 at = corner + ivec2(i % TILE, i / TILE);
        ivec2 pixel = at * 3 + cone_offset(cone);
        tile_position[i] = vec4(0.0);
        if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))) continue;
        float depth = texelFetch(u_depth, pixel, 0).r;
        if (depth >= DEPTH_CLEAR) continue;
        vec2 uv = (vec2(pixel) + 0.5) * u_view.viewport_px.zw;
        tile_position[i] = vec4(position_ws_at(uv, depth), 1.0);
        tile_radiance[i] = texelFetch(u_parts, sub_image_texel(pixel, size), 0);
    }
}

void main() {
    ivec2 size = ivec2(u_view.viewport_px.xy);
    InterleavedPixel own = interleaved_pixel(gl_GlobalInvocationID, size);
    load_tile(size, own.cone);
    barrier();
    if (!own.inside) return;
    ivec2 centre = ivec2(gl_LocalInvocationID.xy) + 1;
    int centre_index = centre.y * TILE + centre.x;
    vec3 p_ws = tile_position[centre_index].xyz;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    if (tile_position[centre_index].w > 0.0) {
        vec3 normal = normal10_decode(texelFetch(u_gbuffer_a, own.pixel, 0).xyz);
        float inverse_tolerance = inverse_plane_tolerance(p_ws);
        int own_part = part_of_pixel(own.pixel);
        for (int other = 0; other < 4; ++other) {
            vec3 direction = CONE_DIRECTIONS[own.cone * CONE_SPLIT + (own_part ^ other)];
            float weight = cone_weight(normal, direction);
            if (weight <= 0.0) continue;
            vec4 cone_sum = vec4(0.0);
            float cone_samples = 0.0;
            ivec2 away = part_offset(other);
            for (int y = -away.y; y <= away.y; y += 2) {
                for (int x = -away.x; x <= away.x; x += 2) {
                    int neighbour = centre_index + y * TILE + x;
                    vec4 position = tile_position[neighbour];
                    if (position.w == 0.0 || tile_radiance[neighbour].a < 0.0) continue;
                    float plane = plane_similarity(position.xyz, p_ws, normal, inverse_tolerance);
                    float similarity = max(plane, LEAST_SIMILARITY);
                    cone_sum += similarity * tile_radiance[neighbour];
                    cone_samples += similarity;
                }
            }
            if (cone_samples <= 0.0) continue;
            sum += cone_sum * (weight / cone_samples);
            weights += weight;
        }
    }
    vec4 mean = weights > 0.0 ? sum / weights : vec4(0.0, 0.0, 0.0, REJECTED);
    imageStore(o_radiance, own.texel, mean);
}
