// Depth of a mesh in one shadow view; the alpha test's inputs where there is one.
#include "shared/instance.glsl"
#include "shared/shadow.glsl"

#include "shared/shadow_pass.glsl"

in vec3 a_position;
in uint a_instance;

#ifdef ALPHA_MASK
in vec2 a_uv0;
in vec2 a_uv1;
in vec4 a_color;

out vec2 v_uv0;
out vec2 v_uv1;
out float v_alpha;
flat out uint v_material;
#endif

void main() {
    vec4 p_ws = instances[a_instance].world_from_local * vec4(a_position, 1.0);
    gl_Position = shadow_views[u_pass.view].clip_from_world * p_ws;
#ifdef ALPHA_MASK
    v_uv0 = a_uv0;
    v_uv1 = a_uv1;
    v_alpha = a_color.a;
    v_material = instances[a_instance].material;
#endif
}
