// The streaks of moving meshes over those of the world behind them.
#include "shared/view.glsl"
#include "lib/motion.glsl"

in vec4 v_now_cs;
in vec4 v_before_cs;
out vec4 o_motion;

void main() {
    o_motion = vec4(half_streak(v_now_cs, v_before_cs, u_view.viewport_px.xy), 0.0, 0.0);
}
