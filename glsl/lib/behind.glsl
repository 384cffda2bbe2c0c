// Radiance behind a translucent surface, from a picture of what is drawn already.
#include "lib/view.glsl"

uniform sampler2D u_behind;  // rgb, a: 1 / distance from the eye's plane; its levels are ever blurrier

const int BEHIND_STEPS = 3;           // towards where the ray meets the picture's surface
const float BEHIND_FARTHEST = 1e4;    // m along the ray: stands for the sky
const float BEHIND_RIM = 0.06;        // share of the picture at its rim where it fades out
const float BEHIND_LEAST_SLOPE = 0.1; // cosine between the ray and the view

vec2 uv_of(vec3 p_ws) {
    vec4 p = u_view.clip_from_world * vec4(p_ws, 1.0);
    return p.xy / max(p.w, 1e-4) * 0.5 + 0.5;
}

// Of the ray from origin on, within a cone. a: how far the picture knows, 0..1.
vec4 radiance_behind(vec3 origin, vec3 direction, float half_angle) {
    vec3 forward = -u_view.world_from_view[2].xyz;
    float z = dot(origin - u_view.eye_ws, forward);
    float slope = dot(direction, forward);
    if (slope < BEHIND_LEAST_SLOPE) return vec4(0.0);
    vec2 uv = uv_of(origin);
    float way = 0.0;
    float met = 0.0;
    for (int i = 0; i < BEHIND_STEPS; ++i) {
        met = textureLod(u_behind, uv, 0.0).a;
        way = clamp((1.0 / max(met, 1e-6) - z) / slope, 0.0, BEHIND_FARTHEST);
        uv = uv_of(origin + direction * way);
    }
    float distance_m = z + slope * way;
    float pixel_m = 2.0 * view_ray().y * distance_m * u_view.viewport_px.w;
    float lod = log2(max(tan(half_angle) * way / pixel_m, 1.0));
    vec2 rim = min(uv, 1.0 - uv) / BEHIND_RIM;
    float known = clamp(min(rim.x, rim.y), 0.0, 1.0);
    // What stands before the surface is not behind it.
    known *= textureLod(u_behind, uv, 0.0).a * z > 1.05 ? 0.0 : 1.0;
    return vec4(textureLod(u_behind, uv, lod).rgb, known);
}
