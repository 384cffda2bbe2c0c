// Shades every occupied leaf voxel and stores its radiance: gather, not scatter.
// [Mittring12 "Voxel Lighting Pipeline": direct light with shadow maps, ambient colour, combine
// with albedo, add emissive]

#include "lib/dispatch.glsl"
#include "lib/ambient_cube.glsl"
#include "lib/packing.glsl"
#include "lib/light_cells.glsl"
#include "lib/lights.glsl"
#include "lib/math.glsl"
#include "lib/shadow.glsl"
#include "lib/voxel_gather.glsl"
#include "lib/voxel_list.glsl"

// 1: gathers what the octree held in the frame before.
#ifndef SPREAD
#define SPREAD 0
#endif

layout(local_size_x = 64) in;

layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) readonly buffer Bricks { Brick bricks[]; };
layout(std430) readonly buffer Attributes { VoxelAttributes attributes[]; };
layout(std430) writeonly buffer Radiance { uint radiance[]; };  // RGB9E5

// Mean of the clamped cosine over all directions, for voxels without a normal of their own.
const float MEAN_COSINE = 0.25;

// A light nearer than this share of a voxel lights the voxel as if it were so far: what is wanted is
// the mean over the voxel, not the value at its lattice point.
const float NEAREST_LIGHT_VOXELS = 0.5;

// normal: the mean one, normalized.
vec3 direct_irradiance(vec3 p_ws, vec3 mean_normal, vec3 normal, float spacing) {
    float certainty = normal_certainty(dot(mean_normal, mean_normal));
    vec3 sum = vec3(0.0);
    for (LightWalk walk = first_light(p_ws); walk.light < light_count(); next_light(walk)) {
        LightSample light = sample_light(lights[walk.light], p_ws, spacing);
        // Of the mean normal as it is: its length makes it the mean cosine of a voxel's surfaces.
        float cosine = mix(MEAN_COSINE, max(dot(mean_normal, light.to_light), 0.0), certainty);
        if (cosine * max(light.irradiance.r, max(light.irradiance.g, light.irradiance.b)) <= 0.0) continue;
        float visibility = light_visibility(walk.light, p_ws, normal, OFF_BY_FOOTPRINT * spacing);
        float nearness = lights[walk.light].kind == LIGHT_DIRECTIONAL
                             ? 1.0 : min(light.distance_m / (NEAREST_LIGHT_VOXELS * spacing), 1.0);
        sum += light.irradiance * (cosine * visibility * nearness * nearness);
    }
    return sum;
}

void main() {
    uint item = linear_thread_id();
    if (item >= octree_state.leaf_voxels.threads) return;
    uint index = leaf_voxel_of_item(item);
    VoxelAttributes voxel = attributes[index];
    uint brick = index / BRICK_VOXELS + octree_state.first_leaf_brick;
    uint octant = index % BRICK_VOXELS;
    uint cell = bricks[brick].cell;
    int level = unpack_cell_level(cell);
    uvec3 point = unpack_cell(cell) * 2u + (uvec3(octant, octant >> 1, octant >> 2) & 1u);
    float spacing = u_octree.origin_size.w / float(2 << level);
    vec3 point_ws = u_octree.origin_size.xyz + vec3(point) * spacing;

    vec3 mean_normal = unpackSnorm4x8(voxel.normal).xyz;
    vec3 normal = mean_normal * inversesqrt(max(dot(mean_normal, mean_normal), 1e-6));
    vec4 albedo = unpackUnorm4x8(voxel.albedo);
    // Leaves of coarser regions know no height: their surfaces lie within half of their voxels.
    float height = level == u_octree.leaf_level ? surface_height_voxels(voxel.normal >> HEIGHT_SHIFT) : 0.5;
    vec3 p_ws = point_ws + normal * (height * spacing);
    vec3 incident = direct_irradiance(p_ws, mean_normal, normal, spacing) * INVERSE_PI;
#if SPREAD
    // Bricks that got other slots hold nothing yet to gather.
    if (octree_state.fresh == 0u)
#endif
    incident += gathered_radiance(p_ws, mean_normal, spacing, octant);
    radiance[index] = rgb9e5_pack(albedo.rgb * incident + rgb9e5_unpack(voxel.emissive));
}
