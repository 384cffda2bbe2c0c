// One of the wide cones from a surface point: octree first, then the sky. [Mittring12 "Shadowed IBL"]

#include "lib/cone.glsl"
#include "lib/cone_directions.glsl"
#include "lib/sky.glsl"

// The march starts off the surface, whose own voxels reach this many finest voxels above it.
const float DIFFUSE_NORMAL_BIAS = 1.0;
const float DIFFUSE_START = 1.0;

// Radiance, and the visibility of the sky.
vec4 diffuse_cone(vec3 p_ws, vec3 normal, vec3 direction) {
    vec3 origin = p_ws + normal * (DIFFUSE_NORMAL_BIAS * u_octree.voxel_m);
    vec4 cone = cone_trace_from(origin, direction, CONE_HALF_ANGLE, DIFFUSE_START * u_octree.voxel_m);
    float visible = 1.0 - cone.a;
    return vec4(cone.rgb + visible * sky_radiance(direction, CONE_HALF_ANGLE), visible);
}
