// Filtered shadow lookups. Two doors:
//   light_visibility          any point of the scene, independent of the camera
//   light_visibility_in_view  a point the camera sees: directional lights take the finest cascade,
//                             with SOFT_SHADOWS lights that have a size cast penumbras, and with
//                             CONTACT_SHADOWS no light falls through where surfaces meet
#include "shared/light.glsl"
#include "shared/shadow.glsl"

uniform sampler2DArrayShadow u_shadow_maps;

// Half width of the 3x3 tent's footprint, in texels, along the diagonal.
const float SHADOW_KERNEL_RADIUS = 2.1213;
// Added to the sine of the angle to the light: a shading normal may lean away from the geometric
// one, and where a thin wall meets a floor the filter must not reach past the wall's foot.
const float SHADOW_OFFSET_BASE = 0.5;

// How far a voxel's surface may be from where it is known to be, by the voxel, and a little more. Much more
// lets light in under eaves and at the foot of walls.
const float OFF_BY_FOOTPRINT = 0.2;

// Texels at a cascade's rim that the filter and the offset may need.
const float SHADOW_CASCADE_MARGIN = 4.0;

// 3x3 tent over bilinear comparisons in four taps: the taps sit where the hardware's own 2x2
// weights add up to the tent's [Castano13 "Shadow Mapping Summary"]. uv: in the view's tile, which
// the taps do not leave.
float shadow_tent_3x3(uint view, vec2 uv, float depth) {
    float size = float(textureSize(u_shadow_maps, 0).x);
    float layer = shadow_views[view].layer;
    vec2 low = shadow_views[view].offset_uv;
    vec2 high = low + shadow_views[view].scale - 0.5 / size;
    vec2 texel_px = (low + uv * shadow_views[view].scale) * size;
    vec2 base = floor(texel_px + 0.5);
    vec2 s = texel_px + 0.5 - base;
    vec2 weight0 = 3.0 - 2.0 * s;
    vec2 weight1 = 1.0 + 2.0 * s;
    vec2 tap0 = clamp((base - 0.5 + (2.0 - s) / weight0 - 1.0) / size, low + 0.5 / size, high);
    vec2 tap1 = clamp((base - 0.5 + s / weight1 + 1.0) / size, low + 0.5 / size, high);
    float lit = weight0.x * weight0.y * texture(u_shadow_maps, vec4(tap0, layer, depth));
    lit += weight1.x * weight0.y * texture(u_shadow_maps, vec4(tap1.x, tap0.y, layer, depth));
    lit += weight0.x * weight1.y * texture(u_shadow_maps, vec4(tap0.x, tap1.y, layer, depth));
    lit += weight1.x * weight1.y * texture(u_shadow_maps, vec4(tap1, layer, depth));
    return lit / 16.0;
}

#ifndef CONTACT_SHADOWS
#define CONTACT_SHADOWS 0
#endif
#if CONTACT_SHADOWS
#include "lib/contact_shadow.glsl"
#endif

bool inside_view(uint view, vec3 p_ws) {
    vec2 p = (shadow_views[view].clip_from_world * vec4(p_ws, 1.0)).xy;
    float edge = 1.0 - 2.0 * SHADOW_CASCADE_MARGIN / float(textureSize(u_shadow_maps, 0).x);
    return max(abs(p.x), abs(p.y)) < edge;
}

// Visibility 0..1 of the light of one view from p_ws, whose surface has the normal n_ws. A plane at
// the angle t to the light differs in depth by r tan(t) within a filter of radius r; moving the
// point r sin(t) along the normal clears that at every angle. offset_m moves it further.
float view_visibility(uint view, vec3 p_ws, vec3 n_ws, vec3 to_light, float offset_m) {
    mat4 clip_from_world = shadow_views[view].clip_from_world;
    vec4 p = clip_from_world * vec4(p_ws, 1.0);
#if CONTACT_SHADOWS
    vec2 own_uv = p.xy / p.w * 0.5 + 0.5;
#endif
    float cosine = dot(n_ws, to_light);
    float sine = sqrt(clamp(1.0 - cosine * cosine, 0.0, 1.0));
    float radius_m = SHADOW_KERNEL_RADIUS * shadow_views[view].texel * abs(p.w);
    float step_m = radius_m * (sine + SHADOW_OFFSET_BASE);
    p += clip_from_world * vec4(n_ws * ((cosine < 0.0 ? -step_m : step_m) + offset_m), 0.0);
    if (p.w <= 0.0) return 1.0;
    vec3 coordinate = p.xyz / p.w * 0.5 + 0.5;
    if (any(greaterThan(abs(coordinate.xy - 0.5), vec2(0.5))) || coordinate.z >= 1.0) return 1.0;
    float depth = coordinate.z - shadow_views[view].depth_bias;
    float lit = shadow_tent_3x3(view, coordinate.xy, depth);
#if CONTACT_SHADOWS
    if (lit > 0.0 && lit < 1.0) {
        float touching = contact_visibility(view, coordinate.xy, coordinate.xy - own_uv, coordinate.z, abs(p.w));
        if (touching != NO_CONTACT) return touching;
    }
#endif
    return lit;
}

uint cube_face(vec3 direction) {
    vec3 size = abs(direction);
    if (size.x >= size.y && size.x >= size.z) return direction.x >= 0.0 ? 0u : 1u;
    if (size.y >= size.z) return direction.y >= 0.0 ? 2u : 3u;
    return direction.z >= 0.0 ? 4u : 5u;
}

// The view of a spot or point light, or of the whole scene, that sees p_ws.
uint view_of(Light light, vec3 p_ws) {
    uint view = uint(light.shadow_view);
    return light.kind == LIGHT_POINT ? view + cube_face(p_ws - light.position_ws) : view;
}

vec3 direction_to(Light light, vec3 p_ws) {
    if (light.kind == LIGHT_DIRECTIONAL) return -light.direction_ws;
    vec3 way = light.position_ws - p_ws;
    return way * inversesqrt(max(dot(way, way), 1e-12));
}

// Visibility 0..1 of a light from a point with the surface normal n_ws. offset_m: a further step
// off the surface, along the normal (a voxel's size, where the surface is only known that well).
float light_visibility(uint light, vec3 p_ws, vec3 n_ws, float offset_m) {
    Light l = lights[light];
    if (l.shadow_view < 0) return 1.0;
    return view_visibility(view_of(l, p_ws), p_ws, n_ws, direction_to(l, p_ws), offset_m);
}

#ifndef SOFT_SHADOWS
#define SOFT_SHADOWS 0
#endif
#if SOFT_SHADOWS
#include "lib/soft_shadow.glsl"
#endif

float light_visibility_in_view(uint light, vec3 p_ws, vec3 n_ws) {
    Light l = lights[light];
    if (l.shadow_view < 0) return 1.0;
    uint view = view_of(l, p_ws);
    for (uint i = l.cascade_count; i > 0u; --i) {
        uint cascade = l.first_cascade + i - 1u;
        if (inside_view(cascade, p_ws)) view = cascade;
    }
#if SOFT_SHADOWS
    if (l.penumbra_radius > 0.0) return soft_visibility(l, view, p_ws, n_ws, direction_to(l, p_ws));
#endif
    return view_visibility(view, p_ws, n_ws, direction_to(l, p_ws), 0.0);
}
