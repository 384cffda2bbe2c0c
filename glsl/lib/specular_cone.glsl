// The specular cone of a pixel: as wide as the lobe of its surface.

#include "lib/cone.glsl"
#include "lib/brdf.glsl"
#include "lib/packing.glsl"
#include "lib/sky.glsl"
#include "lib/view.glsl"

// Finest voxels off the surface along the normal, and along the cone.
const float SPECULAR_NORMAL_BIAS = 1.0;
const float SPECULAR_START = 1.0;

// Radiance along the mirrored eye vector, and the visibility of the sky there.
vec4 specular_cone(vec3 p_ws, vec3 normal, float half_angle) {
    vec3 eye = normalize(p_ws - u_view.eye_ws);
    vec3 direction = reflect(eye, normal);
    // A mirrored ray of a shading normal may point into the surface.
    direction = normalize(direction + normal * max(0.0, 0.02 - dot(direction, normal)));
    vec3 origin = p_ws + normal * (SPECULAR_NORMAL_BIAS * u_octree.voxel_m);
    Clearance clearance = Clearance(SPECULAR_NORMAL_BIAS, dot(direction, normal));
    vec4 cone = cone_trace_above(origin, direction, half_angle, SPECULAR_START * u_octree.voxel_m, clearance);
    float visible = 1.0 - cone.a;
    return vec4(cone.rgb + visible * sky_radiance(direction, half_angle), visible);
}
