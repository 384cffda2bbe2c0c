// A voxel's HDR values along an axis, wherever they are kept: leaves derive theirs from radiance and
// normal, the other levels keep filtered ones. [Mittring12 "Generate directionally dependent voxel"]

#include "lib/lattice.glsl"
#include "lib/octree.glsl"
#include "lib/ambient_cube.glsl"

layout(std430) readonly buffer Bricks { Brick bricks[]; };
layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) readonly buffer Attributes { VoxelAttributes attributes[]; };
// Half floats: radiance premultiplied by opacity, opacity.
layout(std430) readonly buffer Radiance { uvec2 radiance[]; };

// Premultiplied radiance and opacity towards both sides along an axis.
struct AxisVoxel {
    vec4 plus_side;
    vec4 minus_side;
};

vec4 unpack_half4(uvec2 code) { return vec4(unpackHalf2x16(code.x), unpackHalf2x16(code.y)); }
uvec2 pack_half4(vec4 v) { return uvec2(packHalf2x16(v.xy), packHalf2x16(v.zw)); }

const AxisVoxel EMPTY_VOXEL = AxisVoxel(vec4(0.0), vec4(0.0));

AxisVoxel leaf_voxel(uint voxel, uint axis) {
    vec4 value = unpack_half4(radiance[voxel]);
    if (value.a == 0.0) return EMPTY_VOXEL;
    vec3 normal = unpackSnorm4x8(attributes[voxel].normal).xyz;
    float squared = dot(normal, normal);
    float along = axis == 0u ? normal.x : axis == 1u ? normal.y : normal.z;
    float cosine = along * inversesqrt(max(squared, 1e-6));
    return AxisVoxel(vec4(value.rgb * side_visibility(squared, cosine), value.a),
                     vec4(value.rgb * side_visibility(squared, -cosine), value.a));
}

uint leaf_slot(uint brick) { return brick - octree_state.level_first[u_octree.coarsest_leaf]; }

uint voxel_of_point(uvec3 point) {
    uvec3 odd = point & 1u;
    return odd.x | (odd.y << 1) | (odd.z << 2);
}
