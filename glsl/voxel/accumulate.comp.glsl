// Adds every fragment to its voxel in integers, so the sums do not depend on the order.

#include "lib/dispatch.glsl"
#include "lib/regions.glsl"
#include "lib/octree.glsl"
#include "lib/packing.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) readonly buffer Fragments { VoxelFragment fragments[]; };
// Four words a voxel each: count and colour; normal and opacity; emitted radiance and its count.
layout(std430) buffer ColorSums { uint color_sums[]; };
layout(std430) buffer NormalSums { int normal_sums[]; };
layout(std430) buffer EmissiveSums { uint emissive_sums[]; };

void main() {
    uint index = linear_thread_id();
    if (index >= min(octree_state.fragment_count, u_octree.fragment_capacity)) return;
    VoxelFragment fragment = fragments[index];
    int level;
    uvec3 point = leaf_point(unpack_position(fragment.position), level);
    int reached;
    Node node = nodes[find_node(point >> 1u, level, reached)];
    if (reached != level || !node_has_brick(node)) return;  // its node was dropped, and counted

    uint slot = node_brick(node) - octree_state.level_first[u_octree.coarsest_leaf];
    uvec3 odd = point & 1u;
    uint voxel = (slot * BRICK_VOXELS + (odd.x | (odd.y << 1) | (odd.z << 2))) * 4u;
    uvec4 albedo = uvec4(fragment.albedo, fragment.albedo >> 8, fragment.albedo >> 16, fragment.albedo >> 24) & 0xffu;
    atomicAdd(color_sums[voxel], 1u);
    atomicAdd(color_sums[voxel + 1u], albedo.r);
    atomicAdd(color_sums[voxel + 2u], albedo.g);
    atomicAdd(color_sums[voxel + 3u], albedo.b);
    ivec3 normal = ivec3(round(normal_snorm8_unpack(fragment.normal) * 127.0));
    atomicAdd(normal_sums[voxel], normal.x);
    atomicAdd(normal_sums[voxel + 1u], normal.y);
    atomicAdd(normal_sums[voxel + 2u], normal.z);
    atomicAdd(normal_sums[voxel + 3u], int(albedo.a));
    if (u_octree.fixed_point == 0.0) return;
    uvec3 emitted = uvec3(rgb9e5_unpack(fragment.emissive) * u_octree.fixed_point + 0.5);
    if (emitted == uvec3(0u)) return;
    atomicAdd(emissive_sums[voxel], emitted.r);
    atomicAdd(emissive_sums[voxel + 1u], emitted.g);
    atomicAdd(emissive_sums[voxel + 2u], emitted.b);
    atomicAdd(emissive_sums[voxel + 3u], 1u);
}
