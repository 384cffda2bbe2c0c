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

// 1: a voxel traces two of each group's four cones, its neighbours along each axis the other two, and what
// filters them takes the mean. One each would stand as a pattern in mirrors, which see single voxels.
#ifndef SHARED
#define SHARED 0
#endif

const int TRACED_OF_GROUP = SHARED == 1 ? 2 : CONE_SPLIT;

// A voxel's cones by number. Of a group's four those with the numbers 0 and 3 go together, and 1 and 2.
int cone_of_voxel(int number, uint octant) {
    int part = number % TRACED_OF_GROUP;
    if (SHARED == 1) part = int((octant ^ (octant >> 1) ^ (octant >> 2)) & 1u) ^ (part * 3);
    return number / TRACED_OF_GROUP * CONE_SPLIT + part;
}

// Voxels, off the surface, before the cones' own bias.
const float GATHER_OFFSET = 0.25;

// Cosine-weighted mean of the radiance around a voxel's surface. mean_normal: as direct light takes it.
// octant: the voxel's place in its brick.
vec3 gathered_radiance(vec3 p_ws, vec3 mean_normal, float spacing, uint octant) {
    float agreement = length(mean_normal);
    vec3 normal = mean_normal / max(agreement, 1e-3);
    vec3 from = p_ws + normal * (GATHER_OFFSET * spacing);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < CONE_COUNT * TRACED_OF_GROUP; ++i) {
        vec3 direction = CONE_DIRECTIONS[cone_of_voxel(i, octant)];
        float weight = cone_weight(normal, direction);
        if (weight <= 0.0) continue;
        sum += weight * narrow_cone(from, normal, direction).rgb;
        weights += weight;
    }
    float mean_cosine = mix(1.0, agreement, normal_certainty(agreement * agreement));
    vec3 from_lamps = shadowed_irradiance(p_ws, normal, spacing) * INVERSE_PI;
    return sum / max(weights, 1e-6) + mean_cosine * from_lamps;
}
#else
vec3 gathered_radiance(vec3 p_ws, vec3 mean_normal, float spacing, uint octant) { return vec3(0.0); }
#endif
