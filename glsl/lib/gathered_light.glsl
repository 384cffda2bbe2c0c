// Indirect light on a single surface point, gathered by its own cones: for surfaces that are not in
// the G-buffer. CONE_SPLIT 1.
#include "lib/area_shadow.glsl"
#include "lib/diffuse_cone.glsl"
#include "lib/specular_cone.glsl"

const int AREA_SAMPLES = 3;  // of the nine parts of the area lights' light

#if AREA_MAPS == NO_AREA_MAPS
// Light of emissive parallelograms: their closed form, times the share of it that samples find.
vec3 gathered_area_light(vec3 p_ws, vec3 normal) {
    float arrives = 0.0;
    float unshadowed = 0.0;
    for (int i = 0; i < AREA_SAMPLES && u_area_lights.count > 0; ++i) {
        AreaSample s = sample_area_lights(p_ws, normal, i * 4);
        if (s.face < 0 || dot(s.point_ws - p_ws, normal) <= 0.0) continue;
        float light = luminance(s.irradiance);
        unshadowed += light;
        arrives += light * area_visibility(p_ws, normal, s);
    }
    return unshadowed > 0.0 ? area_irradiance(p_ws, normal) * (arrives / unshadowed) : vec3(0.0);
}
#else
// The same, of each light by itself.
vec3 gathered_area_light(vec3 p_ws, vec3 normal) { return shadowed_irradiance(p_ws, normal, 0.0); }
#endif

// Irradiance / pi.
vec3 gathered_diffuse(vec3 p_ws, vec3 normal) {
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int cone = 0; cone < CONE_COUNT; ++cone) {
        float weight = cone_group_weight(normal, cone);
        if (weight <= 0.0) continue;
        sum += weight * diffuse_cone(p_ws, normal, cone).rgb;
        weights += weight;
    }
    return sum / max(weights, 1e-6) + gathered_area_light(p_ws, normal) * INVERSE_PI;
}

// Radiance of the octree and the sky along a ray that comes out of a body.
vec3 gathered_radiance(vec3 origin, vec3 direction, float half_angle) {
    float wide = max(half_angle, 0.01);  // rad: narrower ones cost steps and show no more
    vec4 traced = cone_trace_from(origin, direction, wide, leaf_voxel_m(origin));
    return traced.rgb + (1.0 - traced.a) * sky_radiance(direction, half_angle);
}
