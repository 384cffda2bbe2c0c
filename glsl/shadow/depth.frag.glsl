// Opaque surfaces need no colour; masked ones their alpha test.
#ifdef ALPHA_MASK
#include "lib/material.glsl"

in vec3 v_position_ws;
in vec3 v_normal_ws;
in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
flat in uint v_material;

void main() {
    Surface s = evaluate_material(MaterialInput(v_material, v_position_ws, normalize(v_normal_ws),
        v_uv0, v_uv1, v_color, u_material.time_s));
    if (s.opacity < materials[v_material].alpha_cutoff) discard;
}
#else
void main() {}
#endif
