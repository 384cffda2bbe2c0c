// What translucent surfaces see behind them: radiance, and 1 / distance from the eye's plane, 0
// where nothing is; both may be averaged.
layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/finite.glsl"
#include "lib/view.glsl"
#include "shared/gbuffer.glsl"

uniform sampler2D u_scene_color;
uniform sampler2D u_depth;
layout(rgba16f) writeonly uniform image2D o_behind;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    float depth = texelFetch(u_depth, pixel, 0).r;
    float inverse = depth == DEPTH_CLEAR ? 0.0 : 1.0 / linear_depth(depth);
    imageStore(o_behind, pixel,
               vec4(finite_radiance(texelFetch(u_scene_color, pixel, 0).rgb), inverse));
}
