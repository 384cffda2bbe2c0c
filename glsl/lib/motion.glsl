// Half of the streak, px, that a point leaves which was at another place a frame ago.
#include "shared/motion_blur.glsl"

vec2 half_streak(vec4 now_cs, vec4 before_cs, vec2 size_px) {
    if (before_cs.w <= 0.0) return vec2(0.0);
    vec2 way_px = 0.5 * size_px * (now_cs.xy / now_cs.w - before_cs.xy / before_cs.w);
    vec2 streak = 0.5 * u_motion.shutter * way_px;
    return streak * min(1.0, u_motion.most_px / max(length(streak), 1e-6));
}
