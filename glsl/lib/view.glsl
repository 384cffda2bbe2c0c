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
