// Radiance behind a translucent surface, from a picture of what is drawn already.
#include "lib/view.glsl"

// rgb, a: 1 / distance from the eye's plane; its levels are ever blurrier.
uniform sampler2D u_behind;

const int BEHIND_STEPS = 20;          // over the picture, towards where the ray meets its surface,
const int BEHIND_HALVINGS = 5;        // then within the step that met it
const float BEHIND_FARTHEST = 1e4;    // m along the ray: stands for the sky
const float BEHIND_RIM = 0.06;        // share of the picture at its rim where it fades out
const float BEHIND_LEAST_SLOPE = -0.3;  // cosine between the ray and the view; [inferred: a steeper
                                        // one meets little that the eye sees]
const float BEHIND_GUESS = 0.5;       // how far such a guess is trusted; voxels say the rest
const float BEHIND_GAP = 0.03;        // share of its depth that a ray may be behind what it met

// 1 / distance from the eye's plane of what is drawn at a place of the picture. Of one pixel at a
// silhouette, where a mean would be a surface that is not there.
float inverse_depth_behind(vec2 uv) {
    vec4 around = textureGather(u_behind, uv, 3);
    float most = max(max(around.x, around.y), max(around.z, around.w));
    float least = min(min(around.x, around.y), min(around.z, around.w));
    if (most - least <= BEHIND_GAP * most) return textureLod(u_behind, uv, 0.0).a;
    ivec2 size = textureSize(u_behind, 0);
    return texelFetch(u_behind, clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1), 0).a;
}

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
    vec2 to_rim = (vec2(greaterThan(way, vec2(0.0))) - from)
        / (way + vec2(equal(way, vec2(0.0))) * 1e-9);
    vec2 ends = mix(to_rim, vec2(1.0), lessThan(abs(way), vec2(1e-9)));
    return clamp(min(ends.x, ends.y), 0.0, 1.0);
}

// Whether a ray at a place of the picture has met the surface there: it is behind it, by no more
// than a share `gap` of its depth and `step_m`. Farther behind it passes behind something.
bool meets_picture(vec3 place, float gap, float step_m) {
    float inverse = inverse_depth_behind(place.xy);
    if (inverse < place.z) return false;
    return 1.0 / place.z - 1.0 / inverse <= gap / place.z + step_m;
}

// A guess at what a ray meets out of sight, behind what begins after a place of the picture: what
// is seen there, blurred over the step that passed it. [inferred: floors and walls go on behind
// what stands there]
vec4 guess_behind(vec2 uv, float step_px) {
    return vec4(textureLod(u_behind, uv, log2(max(step_px, 1.0))).rgb, BEHIND_GUESS);
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
    float share = end_in_picture(start.xy, end.xy) / float(BEHIND_STEPS);
    float gap = BEHIND_GAP + half_angle;  // of a wide cone what is beside is a part anyway
    float at = 0.0;
    bool met_it = false;
    vec3 before = start;
    vec3 met = start;
    vec2 seen = vec2(-1.0);               // the last place at which the ray was before the picture
    bool hides = false;
    for (int i = 1; i <= BEHIND_STEPS && !met_it; ++i) {
        before = met;
        at = share * float(i);
        met = mix(start, end, at);
        met_it = meets_picture(met, gap, abs(1.0 / met.z - 1.0 / before.z));
        bool in_sight = inverse_depth_behind(met.xy) < met.z;
        hides = hides || !in_sight;
        if (in_sight && !hides) seen = met.xy;
    }
    float step_px = share * length((end.xy - start.xy) * u_view.viewport_px.xy);
    if (!met_it) return hides && seen.x >= 0.0 ? guess_behind(seen, step_px) : vec4(0.0);
    float from = at - share;
    for (int i = 0; i < BEHIND_HALVINGS; ++i) {
        float middle = 0.5 * (from + at);
        vec3 place = mix(start, end, middle);
        if (meets_picture(place, gap, abs(1.0 / place.z - 1.0 / before.z))) at = middle;
        else from = middle;
    }
    met = mix(start, end, at);
    // Depths are known by pixels: the ray may be as much behind as it goes over two of them.
    float two_pixels = 2.0 / max(length((end.xy - start.xy) * u_view.viewport_px.xy), 1.0);
    float pixels_m = abs(1.0 / met.z - 1.0 / mix(start.z, end.z, max(at - two_pixels, 0.0)));
    if (!meets_picture(met, gap, pixels_m))
        return seen.x >= 0.0 ? guess_behind(seen, step_px) : vec4(0.0);
    float way = min(far * at * end.z / met.z, BEHIND_FARTHEST);
    float pixel_m = 2.0 * view_ray().y / met.z * u_view.viewport_px.w;
    float lod = log2(max(tan(half_angle) * way / pixel_m, 1.0));
    vec2 rim = min(met.xy, 1.0 - met.xy) / BEHIND_RIM;
    return vec4(textureLod(u_behind, met.xy, lod).rgb, clamp(min(rim.x, rim.y), 0.0, 1.0));
}
