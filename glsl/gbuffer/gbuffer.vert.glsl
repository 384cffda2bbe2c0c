// Surface attributes in world space.
#include "shared/view.glsl"
#include "lib/instance.glsl"

in vec3 a_position;
in vec3 a_normal;
in vec4 a_tangent;
in vec2 a_uv0;
in vec2 a_uv1;
in vec4 a_color;
in uint a_instance;

out vec3 v_position_ws;
out vec3 v_normal_ws;
out vec4 v_tangent_ws;
out vec2 v_uv0;
out vec2 v_uv1;
out vec4 v_color;
flat out uint v_material;
flat out float v_scale;  // world lengths by local ones

invariant gl_Position;

void main() {
    mat4 world_from_local = instance_world_from_local(a_instance);
    v_normal_ws = instance_normal_from_local(a_instance) * a_normal;
    v_tangent_ws = vec4(mat3(world_from_local) * a_tangent.xyz, a_tangent.w);
    v_uv0 = a_uv0;
    v_uv1 = a_uv1;
    v_color = a_color;
    v_material = instance_material(a_instance);
    v_scale = length(world_from_local[0].xyz);
    vec4 position_ws = world_from_local * vec4(a_position, 1.0);
    v_position_ws = position_ws.xyz;
    gl_Position = u_view.clip_from_world * position_ws;
}
