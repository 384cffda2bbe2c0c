// Points that touch what may shade them. Included by lib/shadow.glsl.
//
// At the foot of a wall the filter's taps meet the wall nearer to the light on one side of the
// point's own ray, and farther on the other: a line of light along the joint behind the wall, and a
// line of shade before it, as wide as the filter. The four texels around the ray tell the wall's
// plane, and that where the ray meets it, to the precision of the map. [inferred]

// Depths themselves, in the maps that u_shadow_maps compares.
uniform sampler2DArray u_shadow_depths;

// Of a depth's change over a texel: how far four texels may stray from a plane.
const float PLANE_TWIST = 0.25;
// Tangent of a plane's angle to the light at most; what is steeper is a step between two surfaces.
const float STEEPEST = 6.0;
// Of a depth's change over a texel: so near to a plane a point counts as behind it. Where sheets
// meet both have the same depth but for its rounding.
const float ROUNDING = 0.05;
const float AWAY_TEXELS = 1.0;
const float NO_CONTACT = -1.0;

// Metres a unit of depth, at a clip w; w_gradient: of the view's clip w over the world, 0 in a
// directional light's.
float metres_of_depth(vec2 range_m, vec3 w_gradient, float w) {
    float range = range_m.y - range_m.x;
    return dot(w_gradient, w_gradient) > 0.0 ? range * w * w / (range_m.x * range_m.y) : range;
}

// Visibility of the light, 0 or 1, of a point that a plane lies before or behind, by no more than
// its slope makes of the filter's radius; else NO_CONTACT. away: off the point's own surface as the
// light sees it, where the plane is looked for, clear of its foot.
float contact_visibility(uint view, vec2 uv, vec2 away, float depth, float w) {
    float size = float(textureSize(u_shadow_depths, 0).x);
    vec2 place_px = (shadow_views[view].offset_uv + uv * shadow_views[view].scale) * size;
    // The corner that four texels share.
    vec2 corner_px = floor(place_px + AWAY_TEXELS * away / max(length(away), 1e-12) + 0.5);
    // At (0, 1), (1, 1), (1, 0), (0, 0).
    vec4 d = textureGather(u_shadow_depths, vec3(corner_px / size, shadow_views[view].layer));
    vec2 slope = 0.5 * vec2(d.y - d.x + d.z - d.w, d.x - d.w + d.y - d.z);
    float steep = abs(slope.x) + abs(slope.y);
    if (abs(d.y + d.w - d.x - d.z) > PLANE_TWIST * steep) return NO_CONTACT;
    mat4 m = shadow_views[view].clip_from_world;
    float metres = metres_of_depth(shadow_views[view].depth_range_m, vec3(m[0].w, m[1].w, m[2].w),
                                   w);
    if (length(slope) * metres > STEEPEST * shadow_views[view].texel * w) return NO_CONTACT;
    float before = depth - 0.25 * (d.x + d.y + d.z + d.w) - dot(slope, place_px - corner_px);
    if (abs(before) > SHADOW_KERNEL_RADIUS * steep) return NO_CONTACT;
    return before > -ROUNDING * steep ? 0.0 : 1.0;
}
