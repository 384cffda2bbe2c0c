// One of the nine diffuse cones from a surface point: octree first, then the sky. [Mittring12 "Shadowed IBL"]

#include "lib/cone.glsl"
#include "lib/cone_directions.glsl"
#include "lib/sky.glsl"

// The march starts off the surface, whose own voxels reach this many finest voxels above it.
const float DIFFUSE_NORMAL_BIAS = 1.0;
const float DIFFUSE_START = 1.0;

// Sum over a group's cones of weight times (radiance, visibility of the sky); those behind the
// surface are rejected.
vec4 diffuse_cone(vec3 p_ws, vec3 normal, int cone) {
    vec3 origin = p_ws + normal * (DIFFUSE_NORMAL_BIAS * u_octree.voxel_m);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < CONE_SPLIT; ++i) {
        vec3 direction = CONE_DIRECTIONS[cone * CONE_SPLIT + i];
        float weight = cone_weight(normal, direction);
        if (weight <= 0.0) continue;
        vec4 traced = cone_trace_from(origin, direction, CONE_HALF_ANGLE, DIFFUSE_START * u_octree.voxel_m);
        float visible = 1.0 - traced.a;
        sum += weight * vec4(traced.rgb + visible * sky_radiance(direction, CONE_HALF_ANGLE), visible);
    }
    return sum;
}
