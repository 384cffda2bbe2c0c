// Writes the 3x3x3 colours and normals of each brick of the finest level. Encoding: compress.comp.

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

layout(rgba8) writeonly uniform image3D u_colors;
layout(rgba8_snorm) writeonly uniform image3D u_normals;

uint voxel_at[27];  // of the occupied points

void main() {
    uint item = linear_thread_id();
    if (item >= octree_state.leaf_bricks.threads) return;
#if LISTED
    uint brick = finest_brick_of_item(item);
#else
    uint brick = octree_state.first_finest_brick + item;
#endif
    uint cell = bricks[brick].cell;
    Surroundings points = surroundings(ivec3(unpack_cell(cell)), unpack_cell_level(cell), 0u);
    vec3 maximum = vec3(0.0);
    for (uint left = points.occupied; left != 0u; left &= left - 1u) {
        uint voxel;
        uint i = uint(findLSB(left));
        uint owner = owner_of_point(points, place_of_point(i), voxel);
        uint index = leaf_slot(owner) * BRICK_VOXELS + voxel;
        voxel_at[i] = index;
        maximum = max(maximum, leaf_value(index).rgb);
    }
    float inverse_scale = store_multiplier(brick, largest(maximum));

    ivec3 base = leaf_texel(brick - octree_state.first_finest_brick);
#if LISTED
    for (uint left = ~points.occupied & 0x7ffffffu; left != 0u; left &= left - 1u) {
        ivec3 at = base + ivec3(place_of_point(uint(findLSB(left))));
        imageStore(u_colors, at, vec4(0.0));
        imageStore(u_normals, at, vec4(0.0));
    }
#endif
    // Otherwise the atlases were cleared: points without anything stay as they are.
    for (uint left = points.occupied; left != 0u; left &= left - 1u) {
        uint i = uint(findLSB(left));
        uvec3 place = place_of_point(i);
        uint index = voxel_at[i];
        vec4 value = leaf_value(index);
        vec3 normal = unpackSnorm4x8(attributes[index].normal).xyz;
        imageStore(u_colors, base + ivec3(place), vec4(value.rgb * inverse_scale, value.a));
        imageStore(u_normals, base + ivec3(place), vec4(normal * value.a, 0.0));
    }
}
