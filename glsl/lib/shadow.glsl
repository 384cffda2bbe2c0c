// Filtered shadow lookups. Two doors:
//   light_visibility          any point of the scene, independent of the camera
//   light_visibility_in_view  a point the camera sees: directional lights take the finest cascade
#include "shared/light.glsl"
#include "shared/shadow.glsl"

uniform sampler2DArrayShadow u_shadow_cascades;
uniform sampler2DArrayShadow u_shadow_scene;
uniform sampler2DArrayShadow u_shadow_local;

// Half width of the 3x3 tent's footprint, in texels, along the diagonal.
const float SHADOW_KERNEL_RADIUS = 2.1213;
// Added to the sine of the angle to the light: a shading normal may lean away from the geometric
// one, and where a thin wall meets a floor the filter must not reach past the wall's foot.
const float SHADOW_OFFSET_BASE = 0.5;

// Texels at a cascade's rim that the filter and the offset may need.
const float SHADOW_CASCADE_MARGIN = 4.0;

float shadow_compare(uint map, vec2 uv, uint layer, float depth) {
    vec4 coordinate = vec4(uv, float(layer), depth);
    if (map == SHADOW_MAP_CASCADE) return texture(u_shadow_cascades, coordinate);
    if (map == SHADOW_MAP_SCENE) return texture(u_shadow_scene, coordinate);
    return texture(u_shadow_local, coordinate);
}

float shadow_map_size(uint map) {
    if (map == SHADOW_MAP_CASCADE) return float(textureSize(u_shadow_cascades, 0).x);
    if (map == SHADOW_MAP_SCENE) return float(textureSize(u_shadow_scene, 0).x);
    return float(textureSize(u_shadow_local, 0).x);
}

// 3x3 tent over bilinear comparisons in four taps: the taps sit where the hardware's own 2x2
// weights add up to the tent's [Castano13 "Shadow Mapping Summary"].
float shadow_tent_3x3(uint map, vec2 uv, uint layer, float depth) {
    float size = shadow_map_size(map);
    vec2 texel_px = uv * size;
    vec2 base = floor(texel_px + 0.5);
    vec2 s = texel_px + 0.5 - base;
    vec2 weight0 = 3.0 - 2.0 * s;
    vec2 weight1 = 1.0 + 2.0 * s;
    vec2 tap0 = (base - 0.5 + (2.0 - s) / weight0 - 1.0) / size;
    vec2 tap1 = (base - 0.5 + s / weight1 + 1.0) / size;
    float lit = weight0.x * weight0.y * shadow_compare(map, tap0, layer, depth);
    lit += weight1.x * weight0.y * shadow_compare(map, vec2(tap1.x, tap0.y), layer, depth);
    lit += weight0.x * weight1.y * shadow_compare(map, vec2(tap0.x, tap1.y), layer, depth);
    lit += weight1.x * weight1.y * shadow_compare(map, tap1, layer, depth);
    return lit / 16.0;
}

bool inside_view(ShadowView view, vec3 p_ws, float margin_texels) {
    vec4 p = view.clip_from_world * vec4(p_ws, 1.0);
    float edge = 1.0 - 2.0 * margin_texels / shadow_map_size(view.map);
    return p.w > 0.0 && all(lessThan(abs(p.xy), vec2(edge * p.w)));
}

// Visibility 0..1 of the light of one view from p_ws, whose surface has the normal n_ws. A plane at
// the angle t to the light differs in depth by r tan(t) within a filter of radius r; moving the
// point r sin(t) along the normal clears that at every angle. offset_m moves it further.
float view_visibility(ShadowView view, vec3 p_ws, vec3 n_ws, vec3 to_light, float offset_m) {
    float w = (view.clip_from_world * vec4(p_ws, 1.0)).w;
    float cosine = dot(n_ws, to_light);
    float sine = sqrt(clamp(1.0 - cosine * cosine, 0.0, 1.0));
    float radius_m = SHADOW_KERNEL_RADIUS * view.texel * abs(w);
    vec3 side = cosine < 0.0 ? -n_ws : n_ws;
    vec3 receiver = p_ws + side * (radius_m * (sine + SHADOW_OFFSET_BASE)) + n_ws * offset_m;
    vec4 p = view.clip_from_world * vec4(receiver, 1.0);
    if (p.w <= 0.0) return 1.0;
    vec3 coordinate = p.xyz / p.w * 0.5 + 0.5;
    if (any(greaterThan(abs(coordinate.xy - 0.5), vec2(0.5))) || coordinate.z >= 1.0) return 1.0;
    return shadow_tent_3x3(view.map, coordinate.xy, view.layer, coordinate.z - view.depth_bias);
}

uint cube_face(vec3 direction) {
    vec3 size = abs(direction);
    if (size.x >= size.y && size.x >= size.z) return direction.x >= 0.0 ? 0u : 1u;
    if (size.y >= size.z) return direction.y >= 0.0 ? 2u : 3u;
    return direction.z >= 0.0 ? 4u : 5u;
}

// Visibility 0..1 of a light from a point with the surface normal n_ws. offset_m: a further step
// off the surface, along the normal (a voxel's size, where the surface is only known that well).
float light_visibility(uint light, vec3 p_ws, vec3 n_ws, float offset_m) {
    Light l = lights[light];
    if (l.shadow_view < 0) return 1.0;
    uint view = uint(l.shadow_view);
    vec3 to_light = -l.direction_ws;
    if (l.kind != LIGHT_DIRECTIONAL) {
        vec3 offset = l.position_ws - p_ws;
        to_light = normalize(offset);
        if (l.kind == LIGHT_POINT) view += cube_face(-offset);
    }
    return view_visibility(shadow_views[view], p_ws, n_ws, to_light, offset_m);
}

float light_visibility_in_view(uint light, vec3 p_ws, vec3 n_ws) {
    Light l = lights[light];
    if (l.shadow_view < 0 || l.kind != LIGHT_DIRECTIONAL) {
        return light_visibility(light, p_ws, n_ws, 0.0);
    }
    uint view = uint(l.shadow_view);
    for (uint i = l.cascade_count; i > 0u; --i) {
        uint cascade = uint(l.shadow_view) + i;
        if (inside_view(shadow_views[cascade], p_ws, SHADOW_CASCADE_MARGIN)) view = cascade;
    }
    return view_visibility(shadow_views[view], p_ws, n_ws, -l.direction_ws, 0.0);
}
