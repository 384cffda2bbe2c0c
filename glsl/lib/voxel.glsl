// A voxel's HDR value towards each side, wherever it is kept: leaves derive theirs from radiance and
// normal, the other levels keep filtered ones. [Mittring12 "Generate directionally dependent voxel"]

#include "lib/lattice.glsl"
#include "lib/octree.glsl"
#include "lib/ambient_cube.glsl"

layout(std430) readonly buffer Bricks { Brick bricks[]; };
layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) readonly buffer Attributes { VoxelAttributes attributes[]; };
// Half floats: radiance premultiplied by opacity, opacity.
layout(std430) readonly buffer Radiance { uvec2 radiance[]; };

// Six sides of premultiplied radiance and opacity.
struct SidedVoxel {
    vec4 side[6];
};

vec4 unpack_half4(uvec2 code) { return vec4(unpackHalf2x16(code.x), unpackHalf2x16(code.y)); }
uvec2 pack_half4(vec4 v) { return uvec2(packHalf2x16(v.xy), packHalf2x16(v.zw)); }

SidedVoxel empty_voxel() {
    SidedVoxel v;
    for (int i = 0; i < 6; ++i) v.side[i] = vec4(0.0);
    return v;
}

SidedVoxel leaf_voxel(uint voxel) {
    vec4 value = unpack_half4(radiance[voxel]);
    if (value.a == 0.0) return empty_voxel();
    vec3 normal = unpackSnorm4x8(attributes[voxel].normal).xyz;
    vec3 direction = normal * inversesqrt(max(dot(normal, normal), 1e-6));
    SidedVoxel v;
    for (int axis = 0; axis < 3; ++axis) {
        v.side[axis * 2] = vec4(value.rgb * side_visibility(normal, direction[axis]), value.a);
        v.side[axis * 2 + 1] = vec4(value.rgb * side_visibility(normal, -direction[axis]), value.a);
    }
    return v;
}

uint leaf_slot(uint brick) { return brick - octree_state.level_first[u_octree.coarsest_leaf]; }

uint voxel_of_point(uvec3 point) {
    uvec3 odd = point & 1u;
    return odd.x | (odd.y << 1) | (odd.z << 2);
}
