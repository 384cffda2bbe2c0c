// The specular cone of a pixel: as wide as the lobe of its surface.

#include "lib/area_light.glsl"
#include "lib/cone.glsl"
#include "lib/brdf.glsl"
#include "lib/packing.glsl"
#include "lib/sky.glsl"
#include "lib/view.glsl"

// Voxels off the surface along the normal, and along the cone.
const float SPECULAR_NORMAL_BIAS = 1.0;
const float SPECULAR_START = 1.0;
// Voxels before and behind an area light in which its own voxels would hide it.
const float AREA_LIGHT_DEPTH = 1.5;
const int AREA_LIGHTS_MET = 4;  // one behind the other that a cone may meet

// Radiance along the mirrored eye vector, and the visibility of the sky there.
vec4 specular_cone(vec3 p_ws, vec3 normal, float half_angle) {
    vec3 eye = normalize(p_ws - u_view.eye_ws);
    vec3 direction = reflect(eye, normal);
    // A mirrored ray of a shading normal may point into the surface.
    direction = normalize(direction + normal * max(0.0, 0.02 - dot(direction, normal)));
    float voxel = leaf_voxel_m(p_ws);
    vec3 origin = p_ws + normal * (SPECULAR_NORMAL_BIAS * voxel);
    Clearance clearance = Clearance(SPECULAR_NORMAL_BIAS * voxel, dot(direction, normal));
    float depth = AREA_LIGHT_DEPTH * voxel;
    float from = SPECULAR_START * voxel;
    vec4 cone = vec4(0.0);
    for (int i = 0; i < AREA_LIGHTS_MET && cone.a < CONE_OPAQUE; ++i) {
        AreaHit hit = hit_area_lights(origin, direction, half_angle, from, depth);
        if (hit.share == 0.0) break;
        float before = hit.distance_m - depth;
        cone += (1.0 - cone.a) * cone_trace_between(origin, direction, half_angle, from, before,
                                                    clearance, NO_SURFACE);
        cone += (1.0 - cone.a) * hit.share * vec4(hit.radiance, 1.0);
        from = hit.distance_m + depth;
    }
    if (cone.a < CONE_OPAQUE) {
        cone += (1.0 - cone.a) * cone_trace_above(origin, direction, half_angle, from, clearance);
    }
    float visible = 1.0 - cone.a;
    return vec4(cone.rgb + visible * sky_radiance(direction, half_angle), visible);
}
