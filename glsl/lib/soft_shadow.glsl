// Percentage-closer soft shadows of lights that have a size [Fernando05 "Percentage-Closer Soft
// Shadows"]. Included by lib/shadow.glsl.
//
// Samples lie on the plane of the surface that is shaded, spread over a disc as the light sees it:
// each is compared at its own depth, so that no slope needs a bias, and looked up in the view that
// sees it, so that a point light's faces have no seams. The discs are not turned from pixel to
// pixel: a sunflower's points lie apart along every direction, so that edges neither band nor
// grain.

#if !CONTACT_SHADOWS
// Depths themselves, in the maps that u_shadow_maps compares.
uniform sampler2DArray u_shadow_depths;
#endif

const int BLOCKER_SAMPLES = 24;
const int PENUMBRA_SAMPLES = 40;
// The least width of a penumbra, in texels; a light that spans less has the plain filter's.
const float SOFT_TEXELS = 1.5;
// Of the way to the light: blockers nearer to it than that widen the penumbra no more.
const float NEAREST_BLOCKER = 0.5;
// m, how far from a surface blockers of a directional light are looked for [inferred]
const float SUN_BLOCKER_REACH = 10.0;
// Of a local light's height over a surface's plane: what the discs reach of it at most. Rays meet
// the plane no farther away than twice the point, where texels are twice as wide: the lift clears
// them.
const float DISC_OF_HEIGHT = 0.5;
// Of the distance to a local light: what the discs reach of it at most. Beyond it what blocks light
// in one part of the disc says little of the rest, and thin things fall between the samples.
// [inferred]
const float DISC_OF_DISTANCE = 0.2;
const float GOLDEN_ANGLE = 2.39996323;

vec2 sunflower(int i, int count) {
    float angle = float(i) * GOLDEN_ANGLE;
    return sqrt((float(i) + 0.5) / float(count)) * vec2(cos(angle), sin(angle));
}

// A surface point as a light with a size sees it.
struct SoftReceiver {
    vec3 p_ws;
    vec3 n_ws;
    vec3 to_light;
    vec3 across;        // unit, at right angles to to_light and to each other
    vec3 along;
    float lift_m;       // along the normal
};

// Where the ray that passes p_ws at an offset across meets the surface's plane.
vec3 on_plane(Light light, SoftReceiver r, vec2 offset_m) {
    vec3 offset = r.across * offset_m.x + r.along * offset_m.y;
    float cosine = dot(r.n_ws, r.to_light);
    if (light.kind == LIGHT_DIRECTIONAL)
        return r.p_ws + offset - r.to_light * (dot(r.n_ws, offset) / cosine);
    vec3 from_light = r.p_ws + offset - light.position_ws;
    float height = dot(r.n_ws, light.position_ws - r.p_ws);
    return light.position_ws + from_light / (1.0 - dot(r.n_ws, offset) / height);
}

// Place of a sample in its view's layer, and its depth there; w: clip w. seen: false beside a
// cascade, whose last texels tell nothing of what is there.
struct ShadowTap {
    vec3 place;
    float depth;
    float w;
    uint view;
    bool seen;
};

ShadowTap tap_at(Light light, uint view, vec3 p_ws) {
    ShadowTap tap;
    tap.view = light.kind == LIGHT_POINT ? view_of(light, p_ws) : view;
    vec4 p = shadow_views[tap.view].clip_from_world * vec4(p_ws, 1.0);
    vec3 coordinate = p.xyz / p.w * 0.5 + 0.5;
    float edge = 0.5 / (float(textureSize(u_shadow_maps, 0).x) * shadow_views[tap.view].scale);
    vec2 inside = clamp(coordinate.xy, edge, 1.0 - edge);
    tap.place = vec3(shadow_views[tap.view].offset_uv + inside * shadow_views[tap.view].scale,
                     shadow_views[tap.view].layer);
    tap.depth = coordinate.z - shadow_views[tap.view].depth_bias;
    tap.w = p.w;
    tap.seen = light.kind != LIGHT_DIRECTIONAL || inside == coordinate.xy;
    return tap;
}

// Penumbra's radius over the light's, where the depth of a blocker is known: (receiver - blocker) /
// blocker of distances from a local light; of a directional light the way between them in m.
float penumbra_growth(Light light, ShadowTap tap, float blocker_depth) {
    vec2 range_m = shadow_views[tap.view].depth_range_m;
    if (light.kind == LIGHT_DIRECTIONAL)
        return (tap.depth - blocker_depth) * (range_m.y - range_m.x);
    float ndc = blocker_depth * 2.0 - 1.0;
    float blocker_w = 2.0 * range_m.x * range_m.y
        / (range_m.x + range_m.y - ndc * (range_m.y - range_m.x));
    return (tap.w - blocker_w) / blocker_w;
}

// Visibility 0..1 of a light of a size from a point with the surface normal n_ws; view: that sees
// it.
float soft_visibility(Light light, uint view, vec3 p_ws, vec3 n_ws, vec3 to_light) {
    float cosine = dot(n_ws, to_light);
    float sine = sqrt(clamp(1.0 - cosine * cosine, 0.0, 1.0));
    float w = abs((shadow_views[view].clip_from_world * vec4(p_ws, 1.0)).w);
    float texel_m = shadow_views[view].texel * w;
    float growth_max = light.kind == LIGHT_DIRECTIONAL ? SUN_BLOCKER_REACH
        : 1.0 / NEAREST_BLOCKER - 1.0;
    float disc_max = 1e30;
    if (light.kind != LIGHT_DIRECTIONAL) {
        float distance_m = length(light.position_ws - p_ws);
        disc_max = distance_m * min(DISC_OF_HEIGHT * cosine / max(sine, 1e-3), DISC_OF_DISTANCE);
    }
    float search_m = min(light.penumbra_radius * growth_max, disc_max);
    if (cosine <= 0.0 || search_m < SOFT_TEXELS * texel_m)
        return view_visibility(view, p_ws, n_ws, to_light, 0.0);

    SoftReceiver r;
    r.lift_m = SHADOW_KERNEL_RADIUS * texel_m * (sine + SHADOW_OFFSET_BASE);
    r.p_ws = p_ws + n_ws * r.lift_m;
    r.n_ws = n_ws;
    r.to_light = to_light;
    r.across = normalize(abs(to_light.y) < 0.9 ? cross(to_light, vec3(0.0, 1.0, 0.0))
                         : cross(to_light, vec3(1.0, 0.0, 0.0)));
    r.along = cross(to_light, r.across);

    float growth = 0.0;
    int blockers = 0;
    int searched = 0;
    for (int i = 0; i < BLOCKER_SAMPLES; ++i) {
        ShadowTap tap = tap_at(light, view,
                               on_plane(light, r, search_m * sunflower(i, BLOCKER_SAMPLES)));
        if (!tap.seen) continue;
        ++searched;
        float depth = textureLod(u_shadow_depths, tap.place, 0.0).r;
        if (depth >= tap.depth) continue;
        growth += penumbra_growth(light, tap, depth);
        ++blockers;
    }
    if (blockers == 0) return 1.0;
    if (blockers == searched) return 0.0;
    float radius_m = min(light.penumbra_radius * min(growth / float(blockers), growth_max), disc_max);
    if (radius_m < SOFT_TEXELS * texel_m) return view_visibility(view, p_ws, n_ws, to_light, 0.0);
    float lit = 0.0;
    int compared = 0;
    for (int i = 0; i < PENUMBRA_SAMPLES; ++i) {
        ShadowTap tap = tap_at(light, view,
                               on_plane(light, r, radius_m * sunflower(i, PENUMBRA_SAMPLES)));
        if (!tap.seen) continue;
        lit += texture(u_shadow_maps, vec4(tap.place, tap.depth));
        ++compared;
    }
    return lit / float(max(compared, 1));
}
