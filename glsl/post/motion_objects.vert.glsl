// Where a moving mesh is, and where it was.
#include "shared/view.glsl"
#include "lib/instance.glsl"
#include "shared/motion_blur.glsl"

in vec3 a_position;
in uint a_instance;

out vec4 v_now_cs;
out vec4 v_before_cs;

invariant gl_Position;

void main() {
    mat4 world_from_local = instance_world_from_local(a_instance);
    mat4 prev_world_from_local = instance_prev_world_from_local(a_instance);
    gl_Position = u_view.clip_from_world * (world_from_local * vec4(a_position, 1.0));
    v_now_cs = gl_Position;
    v_before_cs = u_motion.prev_clip_from_world * (prev_world_from_local * vec4(a_position, 1.0));
}
