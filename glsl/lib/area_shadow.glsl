// How much of the area lights a surface point sees: through cones or, of those that have them, by
// shadow maps. [Mittring12 "Voxel Lighting": shadowed area lights from emissive materials]

#include "lib/area_light.glsl"

// Which area lights have shadow maps: AREA_MAPS.
#define NO_AREA_MAPS 0
#define SOME_AREA_MAPS 1
#define ALL_AREA_MAPS 2
#ifndef AREA_MAPS
#define AREA_MAPS NO_AREA_MAPS
#endif
// Hidden includes count as included: who reads shadow maps anyway includes lib/shadow.glsl before this.
#if AREA_MAPS != NO_AREA_MAPS
#include "lib/area_map.glsl"
#endif
#include "lib/cone.glsl"

bool has_maps(int light) {
    return AREA_MAPS == ALL_AREA_MAPS || (AREA_MAPS == SOME_AREA_MAPS && u_area_lights.faces[light].shadow_view >= 0);
}

#if AREA_MAPS != ALL_AREA_MAPS
// Voxels: where the march begins off the surface and beyond, and how far over the face's plane
// it ends, below which the face's own voxels and those beside it lie.
const float AREA_NORMAL_BIAS = 1.0;
const float AREA_START = 1.0;
// Up to this height a surface's own voxels reach; a cone that leaves it at a low angle skips as much
// of its way, but no more than AREA_START_MAX.
const float AREA_OWN_HEIGHT = 2.0;
const float AREA_START_MAX = 12.0;
const float AREA_END = 1.5;

// Share of a disc around a point of a face that p_ws sees.
float traced_visibility(vec3 p_ws, vec3 normal, int face, vec3 point_ws, float radius) {
    float voxel = leaf_voxel_m(p_ws);
    float voxel_there = leaf_voxel_m(point_ws);
    vec3 origin = p_ws + normal * (AREA_NORMAL_BIAS * voxel);
    vec3 path = point_ws - origin;
    float way = max(length(path), 1e-6);
    vec3 direction = path / way;
    float height = height_over_light(u_area_lights.faces[face], origin);
    // Before a ball all cones end at the distance of its nearest point.
    bool is_ball = u_area_lights.faces[face].ball_radius > 0.0;
    float cosine = is_ball ? 1.0 : height / way;
    float end = min(way - AREA_END * voxel_there, (height - AREA_END * voxel_there) / max(cosine, 1e-4));
    float half_angle = atan(radius * sqrt(cosine), way);
    Clearance leaves = Clearance(AREA_NORMAL_BIAS * voxel, dot(normal, direction));
    Clearance reaches = Clearance(height, -cosine);
    float start = clamp((AREA_OWN_HEIGHT - AREA_NORMAL_BIAS) / max(leaves.slope, 1e-4), AREA_START, AREA_START_MAX);
    return 1.0 - cone_trace_between(origin, direction, half_angle, start * voxel, end, leaves, reaches).a;
}
#endif

#if SOFT_SHADOWS || AREA_MAPS == NO_AREA_MAPS
// Share of a sample's part of the light that p_ws sees.
float area_visibility(vec3 p_ws, vec3 normal, AreaSample s) {
#if AREA_MAPS != NO_AREA_MAPS
    if (has_maps(s.face)) return disc_visibility(u_area_lights.faces[s.face], s.part, p_ws, normal, s.radius);
#endif
#if AREA_MAPS != ALL_AREA_MAPS
    return traced_visibility(p_ws, normal, s.face, s.point_ws, s.radius);
#endif
}
#endif

// Share of a whole light's irradiance that arrives where a surface is known to within a footprint, m, 0 where
// it is known.
float whole_visibility(vec3 p_ws, vec3 normal, int face, float footprint_m) {
#if AREA_MAPS != NO_AREA_MAPS
    if (has_maps(face)) return mapped_share(u_area_lights.faces[face], p_ws, normal, footprint_m);
#endif
#if AREA_MAPS != ALL_AREA_MAPS
    AreaLight seen = seen_from(u_area_lights.faces[face], p_ws);
    vec3 middle = seen.corner_ws + 0.5 * (seen.edge_u_ws + seen.edge_v_ws);
    return traced_visibility(p_ws, normal, face, middle, sqrt(seen.area_m2 * INVERSE_PI));
#endif
}

// What lies within so many of a voxel's footprints of a light's plane shares voxels with it, and is taken
// for the light.
const float AREA_GAP_FOOTPRINTS = 1.5;

// Irradiance from all lights with shadow, each seen as a whole. footprint_m: see whole_visibility.
vec3 shadowed_irradiance(vec3 p_ws, vec3 normal, float footprint_m) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < u_area_lights.count; ++i) {
        float height = max(height_over_light(u_area_lights.faces[i], p_ws), 0.0);
        if (height < AREA_GAP_FOOTPRINTS * footprint_m) continue;
        AreaLight face = seen_from(u_area_lights.faces[i], p_ws);
        float unshadowed = face_irradiance(face, p_ws, normal);
        if (unshadowed <= 0.0) continue;
        sum += face.radiance * (unshadowed * whole_visibility(p_ws, normal, i, footprint_m));
    }
    return sum;
}
