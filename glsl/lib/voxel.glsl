// A voxel's HDR values, wherever they are kept: leaves derive theirs from radiance and normal, the
// other levels keep filtered ones. [Mittring12 "Generate directionally dependent voxel"]

#include "lib/lattice.glsl"
#include "lib/ambient_cube.glsl"
#include "lib/packing.glsl"

layout(std430) readonly buffer Bricks { Brick bricks[]; };
layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) readonly buffer Attributes { VoxelAttributes attributes[]; };
layout(std430) readonly buffer Radiance { uint radiance[]; };  // RGB9E5

// What viewers on both sides along each axis see: a, the share of a voxel's face that fronts of
// surfaces cover; rgb, their radiance times that share.
struct Sides {
    vec4 plus[3];
    vec4 minus[3];
};

vec4 unpack_half4(uvec2 code) { return vec4(unpackHalf2x16(code.x), unpackHalf2x16(code.y)); }
uvec2 pack_half4(vec4 v) { return uvec2(packHalf2x16(v.xy), packHalf2x16(v.zw)); }

// A leaf's opacity is its material's, along those axes along which its lattice line meets a
// surface.
float leaf_opacity(uint voxel) { return unpackUnorm4x8(attributes[voxel].albedo).a; }

// Bits of the sides that lattice lines meet: +x -x +y -y +z -z.
uint leaf_sides_met(uint voxel) { return attributes[voxel].normal >> SIDES_MET_SHIFT & SIDES_MET_MASK; }

vec3 leaf_opacities(uint voxel) {
    uint met = leaf_sides_met(voxel);
    uint either = met | met >> 1;
    return leaf_opacity(voxel) * vec3(uvec3(either, either >> 2, either >> 4) & 1u);
}

// Premultiplied radiance and opacity.
vec4 leaf_value(uint voxel) {
    float opacity = leaf_opacity(voxel);
    return vec4(rgb9e5_unpack(radiance[voxel]) * opacity, opacity);
}

Sides leaf_sides(uint voxel) {
    vec4 value = leaf_value(voxel);
    uint met = leaf_sides_met(voxel);
    Sides s;
    for (uint axis = 0u; axis < 3u; ++axis) {
        s.plus[axis] = value * float(met >> (2u * axis) & 1u);
        s.minus[axis] = value * float(met >> (2u * axis + 1u) & 1u);
    }
    return s;
}

uint leaf_slot(uint brick) { return brick - octree_state.first_leaf_brick; }

uint voxel_of_point(uvec3 point) {
    uvec3 odd = point & 1u;
    return odd.x | (odd.y << 1) | (odd.z << 2);
}
