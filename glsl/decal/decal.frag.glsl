// A decal on what lies inside its box, blended into the G-buffer before light.
// [Mittring12 "GBuffer": decal mask, stencil masking]
vec2 decal_uv_dx = vec2(0.0);
vec2 decal_uv_dy = vec2(0.0);
#define MATERIAL_UV_DX(uv) decal_uv_dx
#define MATERIAL_UV_DY(uv) decal_uv_dy

#include "lib/decal.glsl"
#include "lib/gbuffer.glsl"
#include "lib/material.glsl"
#include "lib/tangent_space.glsl"
#include "lib/view.glsl"
#include "shared/decals.glsl"

uniform usampler2D u_receivers;  // before any decal

flat in uint v_decal;

layout(location = 0) out vec4 o_scene_color;
layout(location = 1) out vec4 o_a;
layout(location = 2) out vec4 o_b;
layout(location = 3) out vec4 o_c;
layout(location = 4) out vec4 o_d;

// The change of texture coordinates from pixel to pixel, by the receiver's tangent plane:
// differences between neighbours would reach across the edges of what lies in the box.
void set_uv_steps(vec2 uv, vec3 p_ws, vec3 normal_ws, mat3 decal_from_world) {
    vec2 clip = uv * 2.0 - 1.0;
    mat3 world_from_view = mat3(u_view.world_from_view);
    vec2 pixel_ray = 2.0 * u_view.viewport_px.zw * view_ray();
    vec3 ray = world_from_view * vec3(clip * view_ray(), -1.0);
    vec3 p = p_ws - u_view.eye_ws;
    vec3 dx = step_in_plane(p, normal_ws, ray, world_from_view[0] * pixel_ray.x);
    vec3 dy = step_in_plane(p, normal_ws, ray, world_from_view[1] * pixel_ray.y);
    decal_uv_dx = (decal_from_world * dx).xy * vec2(1.0, -1.0);
    decal_uv_dy = (decal_from_world * dy).xy * vec2(1.0, -1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Receiver receiver = receiver_unpack(texelFetch(u_receivers, pixel, 0).xy);
    vec2 uv = gl_FragCoord.xy * u_view.viewport_px.zw;
    vec3 p_ws = position_ws_at(uv, receiver.depth);
    mat4 decal_from_world = decals[v_decal].decal_from_world;
    mat4 world_from_decal = decals[v_decal].world_from_decal;
    vec3 local = (decal_from_world * vec4(p_ws, 1.0)).xyz;
    vec3 normal_ws = normal10_decode(receiver.normal_code);
    float opacity = receiver.mask * decals[v_decal].opacity;
    opacity *= decal_fade(normal_ws, normalize(world_from_decal[2].xyz), decals[v_decal].fade_end,
                          decals[v_decal].fade_scale);
    if (any(greaterThan(abs(local), vec3(0.5))) || opacity <= 0.0) discard;

    set_uv_steps(uv, p_ws, normal_ws, mat3(decal_from_world));
    vec2 decal_uv = vec2(local.x + 0.5, 0.5 - local.y);
    Surface s = evaluate_material(MaterialInput(decals[v_decal].material, p_ws, normal_ws, decal_uv,
                                                decal_uv, vec4(1.0), u_material.time_s));
    opacity *= clamp(s.opacity, 0.0, 1.0);
    GBufferSurface surface;
    surface.normal_ws = surface_normal(s, normal_ws, vec4(normalize(world_from_decal[0].xyz), 1.0),
                                       1.0);
    surface.lighting_model = LIGHTING_DEFAULT;
    surface.specular_color = s.specular_color;
    surface.ambient_occlusion = 1.0;
    surface.albedo = s.albedo;
    surface.decal_mask = 1.0;
    surface.specular_power = s.specular_power;
    surface.subsurface_color = vec3(0.0);
    GBufferTexels texels = gbuffer_pack(surface);
    uint channels = decals[v_decal].channels;
    float color = (channels & DECAL_COLOR) != 0u ? opacity : 0.0;
    o_scene_color = vec4(s.emissive, (channels & DECAL_EMISSION) != 0u ? opacity : 0.0);
    o_a = vec4(texels.a.xyz, (channels & DECAL_NORMAL) != 0u ? opacity : 0.0);
    o_b = vec4(texels.b.rgb, color);
    o_c = vec4(texels.c.rgb, color);
    o_d = vec4(texels.d.rgb, (channels & DECAL_ROUGHNESS) != 0u ? opacity : 0.0);
}
