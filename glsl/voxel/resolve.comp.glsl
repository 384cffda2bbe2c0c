// Turns a voxel's sums into the averages that lighting reads.

#include "lib/dispatch.glsl"
#include "shared/octree.glsl"
#include "lib/packing.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) readonly buffer ColorSums { uvec4 color_sums[]; };
layout(std430) readonly buffer NormalSums { ivec4 normal_sums[]; };
layout(std430) readonly buffer EmissiveSums { uvec4 emissive_sums[]; };
layout(std430) writeonly buffer Attributes { VoxelAttributes attributes[]; };

void main() {
    uint voxel = linear_thread_id();
    if (voxel >= octree_state.leaf_count * BRICK_VOXELS) return;
    VoxelAttributes result = VoxelAttributes(0u, 0u, 0u, 0u);
    uvec4 color = color_sums[voxel];
    if (color.x > 0u) {
        float inverse = 1.0 / float(color.x);
        ivec4 normal = normal_sums[voxel];
        vec4 albedo = vec4(color.yzw, normal.w) * (inverse / 255.0);
        result.albedo = packUnorm4x8(albedo);
        result.normal = packSnorm4x8(vec4(vec3(normal.xyz) * (inverse / 127.0), 0.0));
        // Emission is averaged over what emits: a lamp keeps its power where the ceiling that it
        // hangs from shares its voxels.
        if (u_octree.fixed_point > 0.0) {
            uvec4 emitted = emissive_sums[voxel];
            float scale = 1.0 / (float(max(emitted.w, 1u)) * u_octree.fixed_point);
            result.emissive = rgb9e5_pack(vec3(emitted.xyz) * scale);
        }
        result.fragments = color.x;
    }
    attributes[voxel] = result;
}
