// Averages a voxel's fragments into what lighting reads: see link.comp.

#include "lib/dispatch.glsl"
#include "lib/voxel_list.glsl"
#include "lib/packing.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) readonly buffer Fragments { VoxelFragment fragments[]; };
layout(std430) buffer Attributes { VoxelAttributes attributes[]; };

uvec4 bytes_of(uint word) { return uvec4(word, word >> 8, word >> 16, word >> 24) & 0xffu; }

void main() {
    uint item = linear_thread_id();
    if (item >= octree_state.leaf_voxels.threads) return;
    uint voxel = leaf_voxel_of_item(item);
    uint count = 0u;
    uint emitting = 0u;
    uvec4 albedo = uvec4(0u);
    ivec3 normal = ivec3(0);
    uvec3 emitted = uvec3(0u);
    for (uint link = attributes[voxel].albedo; link != 0u;) {
        VoxelFragment fragment = fragments[link - 1u];
        link = fragment.position;
        ++count;
        albedo += bytes_of(fragment.albedo);
        normal += ivec3(round(normal_snorm8_unpack(fragment.normal) * 127.0));
        uvec3 radiance = uvec3(rgb9e5_unpack(fragment.emissive) * u_octree.fixed_point + 0.5);
        emitted += radiance;
        if (radiance != uvec3(0u)) ++emitting;
    }
    if (count == 0u) return;

    float inverse = 1.0 / float(count);
    VoxelAttributes result;
    result.albedo = packUnorm4x8(vec4(albedo) * (inverse / 255.0));
    result.normal = packSnorm4x8(vec4(vec3(normal) * (inverse / 127.0), 0.0)) & 0x00ffffffu;
    result.normal |= min(count, 255u) << ATTRIBUTES_COUNT_SHIFT;
    // Emission is averaged over what emits: a lamp keeps its power where the ceiling that it hangs
    // from shares its voxels.
    float scale = emitting > 0u ? 1.0 / (float(emitting) * u_octree.fixed_point) : 0.0;
    result.emissive = rgb9e5_pack(vec3(emitted) * scale);
    attributes[voxel] = result;
}
