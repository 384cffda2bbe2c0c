// Opaque surfaces need no colour; masked ones their alpha test. CUT: the map of an area light sees
// neither the light itself nor what is behind it.
#ifdef ALPHA_MASK
#include "lib/material.glsl"
#endif

#ifndef CUT
#define CUT 0
#endif
#if CUT
#include "shared/shadow_pass.glsl"
#endif

#if CUT || defined(ALPHA_MASK)
in vec3 v_position_ws;
#endif
#ifdef ALPHA_MASK
in vec3 v_normal_ws;
in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
flat in uint v_material;
#endif

void main() {
#if CUT
    float height = dot(u_pass.cut_plane.xyz, v_position_ws) + u_pass.cut_plane.w;
    if (height > u_pass.cut_heights_m.x && height < u_pass.cut_heights_m.y) discard;
    if (distance(v_position_ws, u_pass.cut_ball.xyz) < u_pass.cut_ball.w) discard;
#endif
#ifdef ALPHA_MASK
    Surface s = evaluate_material(MaterialInput(v_material, v_position_ws, normalize(v_normal_ws),
        v_uv0, v_uv1, v_color, u_material.time_s));
    if (s.opacity < materials[v_material].alpha_cutoff) discard;
#endif
}
