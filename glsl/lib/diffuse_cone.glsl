// The diffuse cones from a surface point: octree first, then the sky. [Mittring12 "Shadowed IBL"]

#include "lib/cone.glsl"
#include "lib/cone_directions.glsl"
#include "lib/sky.glsl"

// The march starts so many voxels off the surface: more, and it starts inside of what stands close
// over it, as under the bulge of a ring that lies on a floor.
const float DIFFUSE_NORMAL_BIAS = 0.5;
const float DIFFUSE_START = 1.0;
// A cone that points closer to the surface is lifted to this sine: half of it is below anyway.
const float LEAST_ELEVATION = 0.25;

#if CONE_SPLIT == 1
const float SKY_HALF_ANGLE = CONE_HALF_ANGLE;
#else
// Narrow cones' discs leave gaps between them, through which a sun in the sky would fall.
const float SKY_HALF_ANGLE = 1.4 * CONE_HALF_ANGLE;
#endif

// (radiance, visibility of the sky) of a single cone.
vec4 narrow_cone(vec3 p_ws, vec3 normal, vec3 direction) {
    float voxel = leaf_voxel_m(p_ws);
    float elevation = max(dot(normal, direction), LEAST_ELEVATION);
    vec3 lifted = normalize(direction + normal * (elevation - dot(normal, direction)));
    Clearance clearance = Clearance(DIFFUSE_NORMAL_BIAS * voxel, dot(normal, lifted));
    vec3 origin = p_ws + normal * (DIFFUSE_NORMAL_BIAS * voxel);
    vec4 traced = cone_trace_above(origin, lifted, CONE_HALF_ANGLE, DIFFUSE_START * voxel, clearance);
    float visible = 1.0 - traced.a;
    return vec4(traced.rgb + visible * sky_radiance(direction, SKY_HALF_ANGLE), visible);
}

// Mean over a group's cones, by weight; those behind the surface are rejected.
vec4 diffuse_cone(vec3 p_ws, vec3 normal, int cone) {
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < CONE_SPLIT; ++i) {
        vec3 direction = CONE_DIRECTIONS[cone * CONE_SPLIT + i];
        float weight = cone_weight(normal, direction);
        if (weight <= 0.0) continue;
        sum += weight * narrow_cone(p_ws, normal, direction);
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : vec4(0.0, 0.0, 0.0, REJECTED);
}

// One of a group's cones.
vec4 diffuse_cone_part(vec3 p_ws, vec3 normal, int cone, int part) {
    vec3 direction = CONE_DIRECTIONS[cone * CONE_SPLIT + part];
    if (cone_weight(normal, direction) <= 0.0) return vec4(0.0, 0.0, 0.0, REJECTED);
    return narrow_cone(p_ws, normal, direction);
}
