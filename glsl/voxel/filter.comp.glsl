// Directional mip-maps: a voxel of this level from the 27 voxels of the next finer one around it. Along
// an axis, column by column: half, full, half, composited front to back; then the columns' mean by the
// tent [1/4 1/2 1/4]^2. What stands in one column of a thin slanted layer and what stands in the next
// hide different parts, so that their opacities add. Each side from the same side only.
// [Mittring12], [Crassin11], [Gobbetti05]
//
// Each of the 27 is read whole once, for all six sides: what it adds to one is its own value times what
// those before it in its column let through, and that takes no more of them than their opacities.

#include "lib/dispatch.glsl"
#include "lib/surroundings.glsl"
#include "lib/voxel_list.glsl"
#include "shared/octree_level.glsl"

layout(local_size_x = 64) in;

// The opacities of the 27 points along the axes, where they hold anything: half floats.
uvec2 opacities[27];

void keep_opacity(uint number, vec3 along) {
    opacities[number] = uvec2(packHalf2x16(along.xy), packHalf2x16(along.zz));
}

float kept_opacity(uint number, int axis) {
    uvec2 code = opacities[number];
    return axis == 2 ? unpackHalf2x16(code.y).x : unpackHalf2x16(code.x)[axis];
}

// What a point lets through, that is `steps` further along an axis than point i.
float let_through(uint occupied, uint i, int axis, int steps) {
    const ivec3 stride = ivec3(1, 3, 9);
    uint point = uint(int(i) + steps * stride[axis]);
    if ((occupied & (1u << point)) == 0u) return 1.0;
    return 1.0 - kept_opacity(point, axis);
}

// Share of a slab's opacity that half of it has: two in a row hide what the whole does.
float half_slab(float opacity) { return (1.0 - sqrt(max(1.0 - opacity, 0.0))) / max(opacity, 1e-6); }

void main() {
    uint item = linear_thread_id();
    int level = u_level.level;
    if (item >= octree_state.level_voxels[level].threads) return;
    uint voxel = filtered_voxel_of_item(octree_state.level_first[level], item);
    uvec3 own_cell = unpack_cell(bricks[voxel / BRICK_VOXELS].cell);
    uint octant = voxel % BRICK_VOXELS;
    ivec3 point = ivec3(own_cell * 2u + (uvec3(octant, octant >> 1, octant >> 2) & 1u));
    // The finer lattice has this voxel at 2 point, between its cells point - 1 and point.
    Surroundings around = surroundings(point - 1, level + 1, 1u);
    for (uint left = around.occupied; left != 0u; left &= left - 1u) {
        uint i = uint(findLSB(left));
        uint finer;
        uint brick = owner_of_point(around, place_of_point(i), finer);
        keep_opacity(i, opacity_of_voxel(brick, finer));
    }

    vec4 plus[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));  // as viewers on the + sides see it
    vec4 minus[3] = plus;
    vec3 opacity = vec3(0.0);
    for (uint left = around.occupied; left != 0u; left &= left - 1u) {
        uint i = uint(findLSB(left));
        uvec3 place = place_of_point(i);
        uint finer;
        uint brick = owner_of_point(around, place, finer);
        Sides sides = sides_of_voxel(brick, finer);
        vec3 tent = vec3(0.5) - 0.25 * vec3(notEqual(place, uvec3(1u)));
        vec3 share = tent.yzx * tent.zxy;
        for (int axis = 0; axis < 3; ++axis) {
            // The other two of the column: an end, of which half counts, and the middle or other end.
            int at = int(place[axis]) - 1;
            float end = sqrt(let_through(around.occupied, i, axis, at == 0 ? 1 : -2 * at));
            float other = let_through(around.occupied, i, axis, at == 0 ? -1 : -at);
            float own = kept_opacity(i, axis);
            float from_plus = share[axis];
            float from_minus = share[axis];
            if (at == 0) {
                from_plus *= end;
                from_minus *= sqrt(other);
            } else {
                float hidden = end * other;
                from_plus *= (at < 0 ? hidden : 1.0) * half_slab(own);
                from_minus *= (at > 0 ? hidden : 1.0) * half_slab(own);
            }
            plus[axis] += from_plus * sides.plus[axis];
            minus[axis] += from_minus * sides.minus[axis];
            opacity[axis] += from_plus * own;
        }
    }
    uint first = voxel * BRICK_STACKS;
    for (uint axis = 0u; axis < 3u; ++axis) {
        sided[first + axis * 2u] = pack_half4(plus[axis]);
        sided[first + axis * 2u + 1u] = pack_half4(minus[axis]);
    }
    sided[first + BRICK_DIRECTIONS] = pack_half4(vec4(opacity, 0.0));
}
