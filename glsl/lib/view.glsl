// From the depth buffer back to the world. uv: 0..1, row 0 at the bottom.
#include "shared/view.glsl"

vec3 position_ws_at(vec2 uv, float depth) {
    vec4 p = u_view.world_from_clip * vec4(vec3(uv, depth) * 2.0 - 1.0, 1.0);
    return p.xyz / p.w;
}

// Unit vector from the eye through a pixel. Holds for an infinite far plane, whose w is 0.
vec3 eye_ray_ws(vec2 uv) {
    vec4 p = u_view.world_from_clip * vec4(uv * 2.0 - 1.0, 1.0, 1.0);
    return normalize(p.xyz - u_view.eye_ws * p.w);
}

// Distance from the eye's plane in m, from the depth buffer's value.
float linear_depth(float depth) {
    vec4 p = u_view.world_from_clip * vec4(0.0, 0.0, depth * 2.0 - 1.0, 1.0);
    return -(u_view.view_from_world * (p / p.w)).z;
}

// The same of a perspective camera for four at once, from near and far alone.
vec4 linear_depths(vec4 depths) {
    return u_view.near * u_view.far / (u_view.far - depths * (u_view.far - u_view.near));
}

// x, y of the view-space ray of depth 1 through clip (1, 1): the tangents of half the field of
// view.
vec2 view_ray() {
    mat4 m = u_view.clip_from_world;
    vec3 row_x = vec3(m[0].x, m[1].x, m[2].x);
    vec3 row_y = vec3(m[0].y, m[1].y, m[2].y);
    return 1.0 / vec2(dot(row_x, u_view.world_from_view[0].xyz),
                      dot(row_y, u_view.world_from_view[1].xyz));
}
