// Shadow maps of area lights: how much of the light around one of its nine points a place sees.
// The maps look from inside the light, by passes/emitter_views.py.

#include "lib/area_light.glsl"
#include "lib/shadow.glsl"

// The k-th of the points that maps look from.
vec3 shadow_point(AreaLight light, int k) {
    if (light.ball_radius > 0.0) {
        if (k == 0) return light.corner_ws;
        vec3 octant = vec3((ivec3(k - 1) >> ivec3(0, 1, 2)) & 1) * 2.0 - 1.0;
        return light.corner_ws + BALL_SPREAD * light.ball_radius * octant;
    }
    ivec2 count = parts_along(light);
    vec2 at = (vec2(k % count.x, k / count.x) + 0.5) / vec2(count);
    return light.corner_ws + at.x * light.edge_u_ws + at.y * light.edge_v_ws;
}

bool shines_around(AreaLight light) { return light.both_sides != 0.0 || light.ball_radius > 0.0; }

// A way from a light by its own axes: along the first edge, across it, forwards.
vec3 in_frame(AreaLight light, vec3 way_ws) {
    if (light.ball_radius > 0.0) return way_ws;
    vec3 along = normalize(light.edge_u_ws);
    vec3 front = front_of_face(light);
    return vec3(dot(way_ws, along), dot(way_ws, cross(front, along)), dot(way_ws, front));
}

// Which face of the cube around a point a way from there meets, in the light's frame: CUBE.
int cube_side(vec3 way) {
    vec3 size = abs(way);
    if (size.z >= max(size.x, size.y)) return way.z >= 0.0 ? 0 : 5;
    if (size.x >= size.y) return way.x >= 0.0 ? 1 : 2;
    return way.y >= 0.0 ? 3 : 4;
}

// A vector of the light's frame as a face of the cube sees it: right, up, depth.
vec3 seen_through(int side, vec3 v) {
    if (side == 0) return vec3(-v.x, v.y, v.z);
    if (side == 1) return vec3(-v.y, v.z, v.x);
    if (side == 2) return vec3(v.y, v.z, -v.x);
    if (side == 3) return vec3(v.x, v.z, v.y);
    if (side == 4) return vec3(-v.x, v.z, -v.y);
    return vec3(v.x, v.y, -v.z);
}

// The view from the k-th point through a side, or NO_VIEW behind the light.
int emitter_view(AreaLight light, int k, int side) {
    int views = shines_around(light) ? 6 : 5;
    return side < views ? light.shadow_view + k * views + side : NO_VIEW;
}

// Visibility 0..1 of the k-th point alone. offset_m: a further step off the surface.
float point_visibility(AreaLight light, int k, vec3 p_ws, vec3 normal, float offset_m) {
    vec3 way = p_ws - shadow_point(light, k);
    int view = emitter_view(light, k, cube_side(in_frame(light, way)));
    return view == NO_VIEW ? 1.0 : view_visibility(uint(view), p_ws, normal, -normalize(way), offset_m);
}

// Share of a light's irradiance that arrives where a surface is known to within a footprint, m: of its
// nine points, each seen from another ninth of it.
float mapped_share(AreaLight light, vec3 p_ws, vec3 normal, float footprint_m) {
    vec3 across = normalize(abs(normal.y) < 0.9 ? vec3(normal.z, 0.0, -normal.x) : vec3(0.0, normal.z, -normal.y));
    vec3 along = cross(normal, across);
    vec3 front = light.ball_radius > 0.0 ? vec3(0.0) : front_of_face(light);
    float arrives = 0.0;
    float sum = 0.0;
    for (int k = 0; k < AREA_POINTS; ++k) {
        vec3 path = shadow_point(light, k) - p_ws;
        float squared = max(dot(path, path), 1e-12);
        float cosine = dot(path, normal);
        float facing = light.ball_radius > 0.0 ? sqrt(squared) : -dot(path, front);
        if (light.both_sides != 0.0) facing = abs(facing);
        float weight = max(cosine, 0.0) * max(facing, 0.0) / (squared * squared);
        if (weight <= 0.0) continue;
        // Another ninth for each point: their rows are the points' columns.
        vec2 at = (vec2(k / 3, (k + k / 3) % 3) - 1.0) * (footprint_m / 3.0);
        vec3 place = p_ws + at.x * across + at.y * along;
        arrives += weight * point_visibility(light, k, place, normal, OFF_BY_FOOTPRINT * footprint_m);
        sum += weight;
    }
    return sum > 0.0 ? arrives / sum : 0.0;
}

#if SOFT_SHADOWS
// Samples of the disc that a point stands for: a ninth of the light needs fewer than a whole one.
const int NINTH_BLOCKERS = 16;
const int NINTH_SAMPLES = 16;
// Of the ninth's radius: how far around the receiver blockers are looked for; those within a quarter of
// the way from the light widen penumbrae beyond. With 1 the grate leaves stripes. [measured]
const float WIDEST_SEARCH = 3.0;
// The least radius of a penumbra, in texels: a sample is as wide.
const float NINTH_TEXELS = 0.75;
// What the surface may stand out of the plane of its shading normal, in texels, and by the disc's radius.
const float ROUGH_TEXELS = 0.4;
const float ROUGH_SHARE = 0.1;
// Sine between a long face and the way to it, below which its ellipse has no direction.
const float LEAST_SHOWN = 1e-3;

// A surface's plane from a point of a light, in the light's frame, and the place on it that is lit.
struct LitPlane {
    vec3 normal;
    float height;      // of the plane over the point along its normal, negative
    vec3 axis;         // unit, to the place
    float distance_m;
};

// What four neighbouring texels of a map tell: distances there along the map's axis, of the plane, or of what is
// level with the place, beyond which nothing hides the light from it; of what is nearest to the light; and the
// weights of bilinear filtering.
struct Four {
    vec4 plane;
    vec4 nearest;
    vec4 weight;
};

// Each texel is compared with the plane where its own centre meets it, so that no slope needs a bias.
// [Isidoro06 "Shadow Mapping: GPU-based Tips and Techniques", receiver plane]
bool look_at_four(AreaLight light, int k, LitPlane lit, vec3 way, out Four four) {
    int side = cube_side(way);
    int view = emitter_view(light, k, side);
    if (view == NO_VIEW) return false;
    vec3 along = seen_through(side, way);
    vec3 normal = seen_through(side, lit.normal);
    float size = float(textureSize(u_shadow_depths, 0).x);
    float texels = shadow_views[view].scale * size;
    float texel = shadow_views[view].texel;
    vec2 at = along.xy / (along.z * texel) + 0.5 * texels;  // in texels of the tile
    vec2 corner = floor(at + 0.5);                          // that the four share
    vec2 far = at + 0.5 - corner;
    vec2 low = (corner - 0.5 - 0.5 * texels) * texel;
    vec2 high = low + texel;
    // As textureGather gives them: (0, 1), (1, 1), (1, 0), (0, 0).
    vec4 u = vec4(low.x, high.x, high.x, low.x);
    vec4 v = vec4(high.y, high.y, low.y, low.y);
    four.weight = vec4(1.0 - far.x, far.x, far.x, 1.0 - far.x) * vec4(far.y, far.y, 1.0 - far.y, 1.0 - far.y);
    vec4 slope = normal.x * u + normal.y * v + normal.z;
    vec3 axis = seen_through(side, lit.axis);
    vec4 level = lit.distance_m / max(axis.x * u + axis.y * v + axis.z, vec4(1e-6));
    // What looks away from the plane, beyond its horizon, meets it nowhere.
    four.plane = min(lit.height / min(slope, vec4(-1e-6)), level);
    vec2 place = shadow_views[view].offset_uv + corner / size;
    vec4 depth = textureGather(u_shadow_depths, vec3(place, shadow_views[view].layer));
    vec2 range_m = shadow_views[view].depth_range_m;
    depth = 2.0 * (depth + shadow_views[view].depth_bias) - 1.0;
    four.nearest = 2.0 * range_m.x * range_m.y / (range_m.x + range_m.y - depth * (range_m.y - range_m.x));
    return true;
}

// Visibility 0..1 of a disc of the light around its k-th point, of a radius in m, as wide as what hides it
// makes its penumbra; of a long face of an ellipse as long as its part is seen to be. [Fernando05 "Percentage-Closer Soft Shadows"]
float disc_visibility(AreaLight light, int k, vec3 p_ws, vec3 normal, float radius) {
    vec3 p = in_frame(light, p_ws - shadow_point(light, k));
    LitPlane lit;
    lit.normal = in_frame(light, normal);
    lit.height = dot(lit.normal, p);
    int view = emitter_view(light, k, cube_side(p));
    if (view == NO_VIEW || lit.height >= 0.0) return 1.0;
    float distance_m = length(p);
    vec3 axis = p / distance_m;
    lit.axis = axis;
    lit.distance_m = distance_m;
    vec3 across = normalize(abs(axis.y) < 0.9 ? vec3(axis.z, 0.0, -axis.x) : vec3(0.0, axis.z, -axis.y));
    vec3 along = cross(axis, across);
    vec2 radii = vec2(radius);
    ivec2 parts = parts_along(light);
    if (light.ball_radius == 0.0 && parts.x != parts.y) {
        bool first = parts.x > parts.y;
        float u = length(light.edge_u_ws) / float(parts.x);
        float v = length(light.edge_v_ws) / float(parts.y);
        vec3 wide = in_frame(light, normalize(first ? light.edge_u_ws : light.edge_v_ws));
        wide -= dot(wide, axis) * axis;
        float shown = length(wide);
        if (shown > LEAST_SHOWN) {
            across = wide / shown;
            along = cross(axis, across);
        }
        float stretch = sqrt(first ? u / v : v / u);
        radii = radius * vec2(stretch * shown, 1.0 / stretch);
    }
    float cosine = -lit.height / distance_m;
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float texel_m = shadow_views[view].texel * distance_m;
    float disc_max = distance_m * min(DISC_OF_HEIGHT * cosine / max(sine, 1e-3), DISC_OF_DISTANCE);
    float disc_min = min(NINTH_TEXELS * texel_m, disc_max);
    lit.height = min(lit.height + ROUGH_TEXELS * texel_m, 0.5 * lit.height);
    vec2 search_m = clamp(radii * WIDEST_SEARCH, disc_min, disc_max);
    vec2 growth = vec2(0.0);  // summed, and of how many texels
    Four four;
    for (int i = 0; i < NINTH_BLOCKERS; ++i) {
        vec2 at = search_m * sunflower(i, NINTH_BLOCKERS);
        if (!look_at_four(light, k, lit, p + at.x * across + at.y * along, four)) continue;
        vec4 blocks = vec4(lessThan(four.nearest, four.plane));
        growth += vec2(dot(blocks, four.plane / four.nearest - 1.0), dot(blocks, vec4(1.0)));
    }
    if (growth.y == 0.0) return 1.0;
    vec2 radii_m = clamp(radii * growth.x / growth.y, disc_min, disc_max);
    lit.height = min(lit.height + ROUGH_SHARE * max(radii_m.x, radii_m.y), 0.5 * lit.height);
    float arrives = 0.0;
    for (int i = 0; i < NINTH_SAMPLES; ++i) {
        vec2 at = radii_m * sunflower(i, NINTH_SAMPLES);
        if (!look_at_four(light, k, lit, p + at.x * across + at.y * along, four)) arrives += 1.0;
        else arrives += dot(four.weight, vec4(greaterThanEqual(four.nearest, four.plane)));
    }
    return arrives / float(NINTH_SAMPLES);
}
#endif
