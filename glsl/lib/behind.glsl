// Radiance behind a translucent surface, from a picture of what is drawn already.
#include "lib/view.glsl"

uniform sampler2D u_behind;  // rgb, a: 1 / distance from the eye's plane; its levels are ever blurrier

const int BEHIND_STEPS = 16;          // over the picture, towards where the ray meets its surface,
const int BEHIND_HALVINGS = 5;        // then within the step that passed it
const float BEHIND_FARTHEST = 1e4;    // m along the ray: stands for the sky
const float BEHIND_RIM = 0.06;        // share of the picture at its rim where it fades out
const float BEHIND_LEAST_SLOPE = -0.3;  // cosine between the ray and the view; [inferred: a steeper
                                        // one meets little that the eye sees]
const float BEHIND_GAP = 0.1;         // share of its depth that a ray may be behind what it met

// A point's place in the picture and 1 / its distance from the eye's plane: linear along a ray's
// picture, both.
vec3 place_in_picture(vec3 p_ws) {
    vec4 p = u_view.clip_from_world * vec4(p_ws, 1.0);
    float z = dot(p_ws - u_view.eye_ws, -u_view.world_from_view[2].xyz);
    return vec3(p.xy / max(p.w, 1e-4) * 0.5 + 0.5, 1.0 / max(z, 1e-4));
}

// Where the way from one place of the picture to another leaves it, 0..1.
float end_in_picture(vec2 from, vec2 to) {
    vec2 way = to - from;
    vec2 to_rim = (vec2(greaterThan(way, vec2(0.0))) - from) / (way + vec2(equal(way, vec2(0.0))) * 1e-9);
    vec2 ends = mix(to_rim, vec2(1.0), lessThan(abs(way), vec2(1e-9)));
    return clamp(min(ends.x, ends.y), 0.0, 1.0);
}

// Of the ray from origin on, within a cone. a: how far the picture knows, 0..1.
vec4 radiance_behind(vec3 origin, vec3 direction, float half_angle) {
    vec3 forward = -u_view.world_from_view[2].xyz;
    float slope = dot(direction, forward);
    if (slope < BEHIND_LEAST_SLOPE) return vec4(0.0);
    float z = dot(origin - u_view.eye_ws, forward);
    // A ray that comes towards the eye ends before it.
    float far = slope < 0.0 ? min(0.9 * z / -slope, BEHIND_FARTHEST) : BEHIND_FARTHEST;
    vec3 start = place_in_picture(origin);
    vec3 end = place_in_picture(origin + direction * far);
    float last = end_in_picture(start.xy, end.xy);
    float before = 0.0;
    float at = 0.0;
    for (int i = 1; i <= BEHIND_STEPS; ++i) {
        at = last * float(i) / float(BEHIND_STEPS);
        vec3 place = mix(start, end, at);
        if (textureLod(u_behind, place.xy, 0.0).a >= place.z) break;
        before = at;
    }
    for (int i = 0; i < BEHIND_HALVINGS; ++i) {
        float middle = 0.5 * (before + at);
        vec3 place = mix(start, end, middle);
        if (textureLod(u_behind, place.xy, 0.0).a >= place.z) at = middle;
        else before = middle;
    }
    vec3 met = mix(start, end, at);
    float inverse = textureLod(u_behind, met.xy, 0.0).a;
    float way = min(far * at * end.z / met.z, BEHIND_FARTHEST);
    float pixel_m = 2.0 * view_ray().y / met.z * u_view.viewport_px.w;
    float lod = log2(max(tan(half_angle) * way / pixel_m, 1.0));
    vec2 rim = min(met.xy, 1.0 - met.xy) / BEHIND_RIM;
    float known = clamp(min(rim.x, rim.y), 0.0, 1.0);
    // A ray that ends before the picture, or went on behind what stands before its surface.
    bool met_it = inverse >= met.z && inverse * (1.0 - BEHIND_GAP) <= met.z;
    return vec4(textureLod(u_behind, met.xy, lod).rgb, met_it ? known : 0.0);
}
