// Light that bounced: a voxel gathers the octree's previous radiance. Beyond [Mittring12], whose
// voxels receive direct light only. GATHER=0 leaves it out.

#include "lib/lattice.glsl"

#ifndef GATHER
#define GATHER 0
#endif

#if GATHER
#include "lib/cone_directions.glsl"
#include "lib/diffuse_cone.glsl"

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
    return sum / max(weights, 1e-6);
}
#else
vec3 gathered_radiance(vec3 p_ws, vec3 normal, float spacing) { return vec3(0.0); }
#endif
