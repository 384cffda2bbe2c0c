// Evaluates the artist's material at a lattice point and appends it to the fragment queue.
// [Mittring12 "Voxel Lighting Pipeline"]: pixel shader pass, output: fragment queue.

#include "shared/instance.glsl"
#include "shared/octree.glsl"
#include "shared/voxelize.glsl"
#include "lib/lattice.glsl"
#include "lib/material.glsl"
#include "lib/packing.glsl"

in vec3 v_point;
in vec3 v_position_ws;
in vec3 v_normal_ws;
in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
flat in uint v_material;
flat in uint v_flags;

layout(std430) buffer State { OctreeState octree_state; };
layout(std430) buffer Fragments { VoxelFragment fragments[]; };

void main() {
    vec3 normal_ws = normalize(v_normal_ws);
    Surface surface = evaluate_material(MaterialInput(v_material, v_position_ws, normal_ws,
        v_uv0, v_uv1, v_color, u_material.time_s));
    bool masked = (materials[v_material].flags & MATERIAL_MASK) != 0u;
    if (masked && surface.opacity < materials[v_material].alpha_cutoff) discard;
    bool blended = (materials[v_material].flags & MATERIAL_BLEND) != 0u;
    vec3 passes = surface.transmission;
    float hidden = 1.0 - max(passes.r, max(passes.g, passes.b));
    float opacity = blended ? surface.opacity * hidden : 1.0;
    if (opacity < 0.5 / 255.0) discard;  // glass: a voxel could not tell it from nothing

    // The two raster axes are exact by construction; the third is rounded to the nearest point.
    vec3 nearest = floor(v_point + 0.5);
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    if (u_voxelize.axis == 0) nearest.yz = vec2(pixel);
    else if (u_voxelize.axis == 1) nearest.zx = vec2(pixel);
    else nearest.xy = vec2(pixel);
    uvec3 point = uvec3(clamp(nearest, vec3(0.0), vec3(float(u_octree.resolution - 1))));

    uint index = atomicAdd(octree_state.fragment_count, 1u);
    if (index >= u_octree.fragment_capacity) return;  // dropped; counted in queue.comp
    VoxelFragment fragment;
    bool refuses = (v_flags & INSTANCE_REFUSES_DECALS) != 0u || surface.lighting_model == LIGHTING_UNLIT;
    fragment.position = pack_position(point) | decal_mask_bits(refuses ? 0.0 : surface.decal_mask);
    // What a surface mirrors goes on as if it were diffuse: the right power, in all directions.
    vec3 albedo = surface.albedo + mirrored_share(surface.specular_color, surface.roughness);
    fragment.albedo = packUnorm4x8(vec4(albedo, opacity));
    float height = (v_point[u_voxelize.axis] - nearest[u_voxelize.axis]) * normal_ws[u_voxelize.axis];
    fragment.normal = normal_snorm8_pack(normal_ws) | side_met(u_voxelize.axis, normal_ws) << SIDES_MET_SHIFT
                      | surface_height_code(height) << HEIGHT_SHIFT;
    vec3 emissive = min(surface.emissive, materials[v_material].emission_max);
    // The voxels leave out what area lights emit.
    bool area_light = (v_flags & INSTANCE_AREA_LIGHT) != 0u;
    fragment.emissive = rgb9e5_pack(area_light ? vec3(0.0) : emissive);
    fragments[index] = fragment;
}
