// A voxel's HDR values, wherever they are kept: leaves derive theirs from radiance and
// normal, the other levels keep filtered ones. [Mittring12 "Generate directionally dependent voxel"]

#include "lib/lattice.glsl"
#include "lib/ambient_cube.glsl"

layout(std430) readonly buffer Bricks { Brick bricks[]; };
layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) readonly buffer Attributes { VoxelAttributes attributes[]; };
// Half floats: radiance premultiplied by opacity, opacity.
layout(std430) readonly buffer Radiance { uvec2 radiance[]; };

// Premultiplied radiance and opacity towards both sides along each axis.
struct Sides {
    vec4 plus[3];
    vec4 minus[3];
};

vec4 unpack_half4(uvec2 code) { return vec4(unpackHalf2x16(code.x), unpackHalf2x16(code.y)); }
uvec2 pack_half4(vec4 v) { return uvec2(packHalf2x16(v.xy), packHalf2x16(v.zw)); }

Sides leaf_sides(uint voxel) {
    vec4 value = unpack_half4(radiance[voxel]);
    vec3 normal = unpackSnorm4x8(attributes[voxel].normal).xyz;
    float squared = dot(normal, normal);
    vec3 cosine = normal * inversesqrt(max(squared, 1e-6));
    Sides s;
    for (int axis = 0; axis < 3; ++axis) {
        s.plus[axis] = vec4(value.rgb * side_visibility(squared, cosine[axis]), value.a);
        s.minus[axis] = vec4(value.rgb * side_visibility(squared, -cosine[axis]), value.a);
    }
    return s;
}

uint leaf_slot(uint brick) { return brick - octree_state.first_leaf_brick; }

uint voxel_of_point(uvec3 point) {
    uvec3 odd = point & 1u;
    return odd.x | (odd.y << 1) | (odd.z << 2);
}
