// Writes the 3x3x3 colours and normals of each brick of the finest level. Encoding: compress.comp.

#include "lib/dispatch.glsl"
#include "lib/surroundings.glsl"
#include "lib/brick_multiplier.glsl"
#include "lib/brick_atlas.glsl"

layout(local_size_x = 64) in;

layout(rgba8) writeonly uniform image3D u_colors;
layout(rgba8_snorm) writeonly uniform image3D u_normals;

uint voxel_at[27];  // of the occupied points

void main() {
    uint slot = linear_thread_id();
    uint brick = octree_state.interior_count + slot;
    if (brick >= octree_state.brick_count) return;
    uint cell = bricks[brick].cell;
    Surroundings points = surroundings(ivec3(unpack_cell(cell)), unpack_cell_level(cell), 0u);
    vec3 maximum = vec3(0.0);
    for (uint left = points.occupied; left != 0u; left &= left - 1u) {
        uint voxel;
        uint i = uint(findLSB(left));
        uint owner = owner_of_point(points, place_of_point(i), voxel);
        uint index = leaf_slot(owner) * BRICK_VOXELS + voxel;
        voxel_at[i] = index;
        maximum = max(maximum, unpack_half4(radiance[index]).rgb);
    }
    float inverse_scale = store_multiplier(brick, largest(maximum));

    // The atlases were cleared: points without anything stay as they are.
    ivec3 base = leaf_texel(slot);
    for (uint left = points.occupied; left != 0u; left &= left - 1u) {
        uint i = uint(findLSB(left));
        uvec3 place = place_of_point(i);
        uint index = voxel_at[i];
        vec4 value = unpack_half4(radiance[index]);
        vec3 normal = unpackSnorm4x8(attributes[index].normal).xyz;
        imageStore(u_colors, base + ivec3(place), vec4(value.rgb * inverse_scale, value.a));
        imageStore(u_normals, base + ivec3(place), vec4(normal * value.a, 0.0));
    }
}
