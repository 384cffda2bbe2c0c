// Cones towards area lights: how much of them a surface point sees.
// [Mittring12 "Voxel Lighting": shadowed area lights from emissive materials]

#include "lib/area_light.glsl"
#include "lib/cone.glsl"

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
float area_visibility(vec3 p_ws, vec3 normal, int face, vec3 point_ws, float radius) {
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
