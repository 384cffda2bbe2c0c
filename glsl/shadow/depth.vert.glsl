// Depth of a mesh in one shadow view; the alpha test's inputs where there is one.
#include "lib/instance.glsl"

#include "shared/shadow_pass.glsl"

#ifndef CUT
#define CUT 0
#endif

in vec3 a_position;
in uint a_instance;

#if CUT || defined(ALPHA_MASK)
out vec3 v_position_ws;
#endif
#ifdef ALPHA_MASK
in vec3 a_normal;
in vec2 a_uv0;
in vec2 a_uv1;
in vec4 a_color;

out vec3 v_normal_ws;
out vec2 v_uv0;
out vec2 v_uv1;
out vec4 v_color;
flat out uint v_material;
#endif

void main() {
    vec4 p_ws = instance_world_from_local(a_instance) * vec4(a_position, 1.0);
    gl_Position = u_pass.clip_from_world * p_ws;
#if CUT || defined(ALPHA_MASK)
    v_position_ws = p_ws.xyz;
#endif
#ifdef ALPHA_MASK
    v_normal_ws = instance_normal_from_local(a_instance) * a_normal;
    v_uv0 = a_uv0;
    v_uv1 = a_uv1;
    v_color = a_color;
    v_material = instance_material(a_instance);
#endif
}
