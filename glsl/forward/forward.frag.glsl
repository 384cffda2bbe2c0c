// One translucent surface, lit like the opaque ones, over what is behind it (premultiplied). Its
// indirect light is borrowed: diffuse from the surface behind, specular from the sky as far as that
// surface sees it.
#ifndef GI
#define GI 1
#endif

#include "lib/direct.glsl"
#include "lib/material.glsl"
#include "lib/sky.glsl"
#include "lib/tangent_space.glsl"
#include "lib/view.glsl"

#if GI
uniform sampler2D u_diffuse_gi;  // irradiance / pi; a: visibility of the sky
#endif

in vec3 v_position_ws;
in vec3 v_normal_ws;
in vec4 v_tangent_ws;
in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
flat in uint v_material;

layout(location = 0) out vec4 o_radiance;

vec3 shade_translucent(Surface s, vec3 n_ws, vec3 p_ws) {
    ShadingPoint point = seen_point(p_ws, n_ws, s.albedo, s.specular_color, s.specular_power,
                                    s.subsurface_color, s.lighting_model);
    DirectLight direct = direct_light(point);
    vec3 radiance = s.emissive + direct.diffuse + direct.specular;
#if GI
    vec4 diffuse_gi = texelFetch(u_diffuse_gi, ivec2(gl_FragCoord.xy), 0);
    vec3 mirrored = sky_radiance(reflect(-point.to_eye, n_ws),
                                 specular_cone_half_angle(s.specular_power));
    vec3 indirect = diffuse_gi.rgb * (point.albedo + point.subsurface_color);
    indirect += mirrored * clamp(diffuse_gi.a, 0.0, 1.0) * point.mirrored;
    indirect *= s.ambient_occlusion;
    radiance += indirect * u_view.indirect;
#endif
    return radiance;
}

void main() {
    float facing = gl_FrontFacing ? 1.0 : -1.0;
    Surface s = evaluate_material(MaterialInput(v_material, v_position_ws,
        normalize(v_normal_ws) * facing, v_uv0, v_uv1, v_color, u_material.time_s));
    vec3 n_ws = surface_normal(s, v_normal_ws, v_tangent_ws, facing);
    vec3 p_ws = position_ws_at(gl_FragCoord.xy * u_view.viewport_px.zw, gl_FragCoord.z);
    vec3 radiance = s.lighting_model == LIGHTING_UNLIT ? s.emissive : shade_translucent(s, n_ws, p_ws);
    o_radiance = vec4(radiance * s.opacity, s.opacity);
}
