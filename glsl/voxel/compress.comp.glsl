// Writes the 6 x 3x3x3 texels of each brick above the finest level, as RGBA8 under one power of two.
// [Mittring12 "Generate mip-maps, Create redundant border, Compress": HDR multiplier, LDR colour]
//
// Border and neighbour encode the same HDR value. A power of two keeps them equal to the bit where
// both bricks have the same multiplier, and rounding to nearest keeps the error of a voxel at or
// below 1/255 of its brick's largest value: half a step of at most twice that value.

#include "lib/dispatch.glsl"
#include "lib/brick_points.glsl"
#include "lib/brick_atlas.glsl"

layout(local_size_x = 64) in;

layout(rgba8) writeonly uniform image3D u_atlas;

// The largest value of a voxel's sides. Some side of a leaf shows its radiance whole.
float largest_side(uint brick, uint voxel) {
    if ((bricks[brick].cell & BRICK_LEAF) != 0u) {
        return largest(unpack_half4(radiance[leaf_slot(brick) * BRICK_VOXELS + voxel]).rgb);
    }
    float maximum = 0.0;
    for (uint side = 0u; side < BRICK_DIRECTIONS; ++side) {
        maximum = max(maximum, largest(unpack_half4(sided[sided_index(brick, voxel, side)]).rgb));
    }
    return maximum;
}

void main() {
    uint brick = linear_thread_id();
    if (brick >= octree_state.interior_count) return;
    BrickPoints points = brick_points(brick);
    float maximum = 0.0;
    for (uint left = points.occupied; left != 0u; left &= left - 1u) {
        uint voxel;
        uint owner = owner_of_point(points, texel_of_point(uint(findLSB(left))), voxel);
        maximum = max(maximum, largest_side(owner, voxel));
    }
    float inverse_scale = store_multiplier(brick, maximum);

    // The atlas was cleared: points without anything stay as they are.
    ivec3 base = brick_texel(brick);
    for (uint left = points.occupied; left != 0u; left &= left - 1u) {
        uvec3 texel = texel_of_point(uint(findLSB(left)));
        uint voxel;
        uint owner = owner_of_point(points, texel, voxel);
        for (uint axis = 0u; axis < 3u; ++axis) {
            AxisVoxel v = brick_voxel(owner, voxel, axis);
            ivec3 at = base + ivec3(texel) + ivec3(0, 0, axis * 2u * BRICK_SIDE);
            imageStore(u_atlas, at, vec4(v.plus_side.rgb * inverse_scale, v.plus_side.a));
            imageStore(u_atlas, at + ivec3(0, 0, BRICK_SIDE), vec4(v.minus_side.rgb * inverse_scale, v.minus_side.a));
        }
    }
}
