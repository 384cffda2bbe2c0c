// Light that bounced: a voxel gathers the octree's previous radiance. Beyond [Mittring12], whose
// voxels receive direct light only. GATHER=0 leaves it out.

#include "lib/lattice.glsl"

#ifndef GATHER
#define GATHER 0
#endif

#if GATHER
#include "lib/area_shadow.glsl"
#include "lib/cone_directions.glsl"
#include "lib/diffuse_cone.glsl"

// Cosine-weighted mean of the radiance that comes from the faces of area lights, a cone each.
// What lies within AREA_GAP_VOXELS of a face's plane shares voxels with it, and is taken for the face.
const float AREA_GAP_VOXELS = 1.5;

vec3 area_light_radiance(vec3 p_ws, vec3 normal, float spacing) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < u_area_lights.count; ++i) {
        AreaLight face = u_area_lights.faces[i];
        if (abs(height_over_face(face, p_ws)) < AREA_GAP_VOXELS * spacing) continue;
        float unshadowed = face_irradiance(face, p_ws, normal);
        if (unshadowed <= 0.0) continue;
        vec3 middle = face.corner_ws + 0.5 * (face.edge_u_ws + face.edge_v_ws);
        sum += face.radiance * (unshadowed * area_visibility(p_ws, normal, i, middle, sqrt(face.area_m2 * INVERSE_PI)));
    }
    return sum * INVERSE_PI;
}

// Cosine-weighted mean of the radiance around the normal.
vec3 gathered_radiance(vec3 p_ws, vec3 normal, float spacing) {
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < CONE_COUNT; ++i) {
        float weight = cone_group_weight(normal, i);
        if (weight <= 0.0) continue;
        sum += weight * diffuse_cone(p_ws + normal * (0.5 * spacing), normal, i).rgb;
        weights += weight;
    }
    return sum / max(weights, 1e-6) + area_light_radiance(p_ws, normal, spacing);
}
#else
vec3 gathered_radiance(vec3 p_ws, vec3 normal, float spacing) { return vec3(0.0); }
#endif
