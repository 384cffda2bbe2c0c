// Directional mip-maps: a voxel of this level from the 27 voxels of the next finer one around it.
// Across the axis a tent [1/4 1/2 1/4]^2, along it half, full, half, composited front to back; each
// side from the same side only. [Mittring12], [Crassin11], [Gobbetti05]

#include "lib/sided_voxel.glsl"
#include "shared/octree_level.glsl"

layout(local_size_x = 64) in;

// Half of a slab: two halves in a row are as opaque as the whole.
vec4 half_slab(vec4 slab) {
    float opacity = 1.0 - sqrt(max(1.0 - slab.a, 0.0));
    return vec4(slab.rgb * (opacity / max(slab.a, 1e-6)), opacity);
}

vec4 over(vec4 front, vec4 back) { return front + (1.0 - front.a) * back; }

void main() {
    uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * BRICK_GROUP;
    int level = u_level.level;
    uint first = octree_state.level_first[level];
    uint brick = first + index / BRICK_VOXELS;
    if (brick >= octree_state.level_first[level + 1]) return;
    if ((bricks[brick].cell & BRICK_LEAF) != 0u) return;

    uint octant = index % BRICK_VOXELS;
    ivec3 point = ivec3(unpack_cell(bricks[brick].cell) * 2u + (uvec3(octant, octant >> 1, octant >> 2) & 1u));
    ivec3 centre = point * 2;  // on the finer lattice; its cells there are point - 1 and point
    int finer = level + 1;

    uint cell_brick[8];
    int cell_level[8];
    for (int i = 0; i < 8; ++i) {
        ivec3 cell = point - 1 + (ivec3(i, i >> 1, i >> 2) & 1);
        cell_brick[i] = brick_of_cell(cell, finer, cell_level[i]);
    }

    // [axis][slab][side of the axis]
    vec4 slabs[18];
    for (int i = 0; i < 18; ++i) slabs[i] = vec4(0.0);
    for (int i = 0; i < 27; ++i) {
        ivec3 offset = ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
        ivec3 in_cell = ivec3(greaterThanEqual(offset, ivec3(0)));
        int cell = in_cell.x | (in_cell.y << 1) | (in_cell.z << 2);
        if (cell_brick[cell] == NO_BRICK) continue;
        SidedVoxel v = voxel_at(cell_brick[cell], cell_level[cell], uvec3(centre + offset), finer);
        vec3 weight = vec3(0.5) - 0.25 * vec3(abs(offset));
        vec3 across = weight.yzx * weight.zxy;
        for (int axis = 0; axis < 3; ++axis) {
            int slab = axis * 6 + (offset[axis] + 1) * 2;
            slabs[slab] += across[axis] * v.side[axis * 2];
            slabs[slab + 1] += across[axis] * v.side[axis * 2 + 1];
        }
    }
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint s = axis * 6u;
        vec4 plus_side = over(half_slab(slabs[s + 4u]), over(slabs[s + 2u], half_slab(slabs[s])));
        vec4 minus_side = over(half_slab(slabs[s + 1u]), over(slabs[s + 3u], half_slab(slabs[s + 5u])));
        sided[sided_index(brick, octant, axis * 2u)] = pack_half4(plus_side);
        sided[sided_index(brick, octant, axis * 2u + 1u)] = pack_half4(minus_side);
    }
}
