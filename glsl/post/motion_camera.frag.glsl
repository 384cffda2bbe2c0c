// How the camera's motion moves each pixel of a world that stands still. [Rosado07 "Motion Blur as
// a Post-Processing Effect"]
#include "lib/view.glsl"
#include "lib/motion.glsl"
#include "lib/packing.glsl"

uniform sampler2D u_depth;

out vec4 o_motion;  // half of the streak in px; b: m along the view

void main() {
    vec2 size = vec2(textureSize(u_depth, 0));
    float depth = texelFetch(u_depth, ivec2(gl_FragCoord.xy), 0).r;
    vec4 now_cs = vec4(2.0 * vec3(gl_FragCoord.xy / size, depth) - 1.0, 1.0);
    vec4 p_ws = u_view.world_from_clip * now_cs;
    vec4 before_cs = u_motion.prev_clip_from_world * p_ws;
    o_motion = vec4(half_streak(now_cs, before_cs / p_ws.w, size),
                    min(linear_depth(depth), HALF_MAX), 0.0);
}
