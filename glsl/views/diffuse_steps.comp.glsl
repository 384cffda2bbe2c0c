// How many samples a diffuse cone takes: the mean over all of a pixel's, of which a frame traces
// one group and takes the others from the pixels around.

#include "lib/cone_steps.glsl"
#include "lib/diffuse_cone.glsl"
#include "lib/packing.glsl"
#include "lib/view.glsl"
#include "shared/gbuffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
layout(rgba8) writeonly uniform image2D o_image;

const float STEPS_WHITE = 64.0;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    float depth = texelFetch(u_depth, pixel, 0).r;
    int cones = 0;
    if (depth < DEPTH_CLEAR) {
        vec3 normal = normal10_decode(texelFetch(u_gbuffer_a, pixel, 0).xyz);
        vec3 p_ws = position_ws_at((vec2(pixel) + 0.5) * u_view.viewport_px.zw, depth);
        for (int group = 0; group < CONE_COUNT; ++group) diffuse_cone(p_ws, normal, group);
        for (int i = 0; i < CONE_COUNT * CONE_SPLIT; ++i)
            cones += int(cone_weight(normal, CONE_DIRECTIONS[i]) > 0.0);
    }
    imageStore(o_image, pixel, vec4(steps_color(cone_steps, cones, STEPS_WHITE), 1.0));
}
