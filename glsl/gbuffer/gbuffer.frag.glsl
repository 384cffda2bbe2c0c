// The G-buffer of one surface. [Mittring12 "GBuffer" table]
#include "lib/gbuffer.glsl"
#include "lib/material.glsl"
#include "lib/tangent_space.glsl"

in vec3 v_position_ws;
in vec3 v_normal_ws;
in vec4 v_tangent_ws;
in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
flat in uint v_material;

layout(location = 0) out vec4 o_scene_color;
layout(location = 1) out vec4 o_a;
layout(location = 2) out vec4 o_b;
layout(location = 3) out vec4 o_c;
layout(location = 4) out vec4 o_d;

#if MATERIAL_FAULTS && !defined(ALPHA_MASK)
// What is hidden tells of no faults, and writing them turns no early test off.
layout(early_fragment_tests) in;
#endif

void main() {
    float facing = gl_FrontFacing ? 1.0 : -1.0;
    Surface s = evaluate_material(MaterialInput(v_material, v_position_ws,
        normalize(v_normal_ws) * facing, v_uv0, v_uv1, v_color, u_material.time_s));
#ifdef ALPHA_MASK
    if (s.opacity < materials[v_material].alpha_cutoff) discard;
#endif
    GBufferSurface surface;
    surface.normal_ws = surface_normal(s, v_normal_ws, v_tangent_ws, facing);
    surface.lighting_model = s.lighting_model;
    surface.specular_color = s.specular_color;
    surface.ambient_occlusion = s.ambient_occlusion;
    surface.albedo = s.albedo;
    surface.decal_mask = clamp(s.decal_mask, 0.0, 1.0);
    surface.specular_power = s.specular_power;
    surface.subsurface_color = s.subsurface_color;
    GBufferTexels texels = gbuffer_pack(surface);
    o_scene_color = vec4(s.emissive, 1.0);
    o_a = texels.a;
    o_b = texels.b;
    o_c = texels.c;
    o_d = texels.d;
}
