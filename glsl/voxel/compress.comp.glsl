// Writes the 7 x 3x3x3 texels of each brick above the finest level, as RGBA8 under one power of two.
// [Mittring12 "Generate mip-maps, Create redundant border, Compress": HDR multiplier, LDR colour]
//
// Border and neighbour encode the same HDR value. A power of two keeps them equal to the bit where
// both bricks have the same multiplier, and rounding to nearest keeps the error of a voxel at or
// below 1/255 of its brick's largest value: half a step of at most twice that value.
//
// LISTED=1: only the listed bricks, whose other texels may hold what was there before.

#include "lib/dispatch.glsl"
#include "lib/surroundings.glsl"
#include "lib/brick_multiplier.glsl"
#include "lib/brick_atlas.glsl"
#ifndef LISTED
#define LISTED 0
#endif
#if LISTED
#include "lib/voxel_list.glsl"
#endif

layout(local_size_x = 64) in;

layout(rgba8) writeonly uniform image3D u_atlas;

void main() {
    uint brick = linear_thread_id();
    if (brick >= octree_state.interior_bricks.threads) return;
#if LISTED
    brick = interior_brick_of_item(brick);
#endif
    uint cell = bricks[brick].cell;
    Surroundings points = surroundings(ivec3(unpack_cell(cell)), unpack_cell_level(cell), 0u);
    vec3 maximum = vec3(0.0);
    for (uint left = points.occupied; left != 0u; left &= left - 1u) {
        uint voxel;
        uint owner = owner_of_point(points, place_of_point(uint(findLSB(left))), voxel);
        Sides sides = sides_of_voxel(owner, voxel);
        for (int axis = 0; axis < 3; ++axis) {
            maximum = max(maximum, max(sides.plus[axis].rgb, sides.minus[axis].rgb));
        }
    }
    float inverse_scale = store_multiplier(brick, largest(maximum));

    ivec3 base = brick_texel(brick);
#if LISTED
    for (uint left = ~points.occupied & 0x7ffffffu; left != 0u; left &= left - 1u) {
        ivec3 at = base + ivec3(place_of_point(uint(findLSB(left))));
        for (uint stack = 0u; stack < BRICK_STACKS; ++stack) {
            imageStore(u_atlas, at + ivec3(0, 0, stack * BRICK_SIDE), vec4(0.0));
        }
    }
#endif
    // Otherwise the atlas was cleared: points without anything stay as they are.
    for (uint left = points.occupied; left != 0u; left &= left - 1u) {
        uvec3 place = place_of_point(uint(findLSB(left)));
        uint voxel;
        uint owner = owner_of_point(points, place, voxel);
        Sides sides = sides_of_voxel(owner, voxel);
        for (int axis = 0; axis < 3; ++axis) {
            ivec3 at = base + ivec3(place) + ivec3(0, 0, axis * 2 * int(BRICK_SIDE));
            imageStore(u_atlas, at, vec4(sides.plus[axis].rgb * inverse_scale, sides.plus[axis].a));
            at.z += int(BRICK_SIDE);
            imageStore(u_atlas, at, vec4(sides.minus[axis].rgb * inverse_scale, sides.minus[axis].a));
        }
        ivec3 above = base + ivec3(place) + ivec3(0, 0, BRICK_DIRECTIONS * BRICK_SIDE);
        imageStore(u_atlas, above, vec4(opacity_of_voxel(owner, voxel), 0.0));
    }
}
