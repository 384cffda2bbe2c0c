// Directional mip-maps: a voxel of this level from the 27 voxels of the next finer one around it.
// Across the axis a tent [1/4 1/2 1/4]^2, along it half, full, half, composited front to back; each
// side from the same side only. [Mittring12], [Crassin11], [Gobbetti05]

#include "lib/dispatch.glsl"
#include "lib/sided_voxel.glsl"
#include "lib/voxel_list.glsl"
#include "shared/octree_level.glsl"

layout(local_size_x = 64) in;

// Half of a slab: two halves in a row are as opaque as the whole.
vec4 half_slab(vec4 slab) {
    float opacity = 1.0 - sqrt(max(1.0 - slab.a, 0.0));
    return vec4(slab.rgb * (opacity / max(slab.a, 1e-6)), opacity);
}

vec4 over(vec4 front, vec4 back) { return front + (1.0 - front.a) * back; }

// The 2x2x2 cells of the next finer level around a voxel.
struct Cells {
    uint brick[8];
    int reached[8];
    uint points[8];
};

// The brick of a cell of the next finer level. The node's own children need no descent.
uint finer_brick(uvec3 own_cell, uint own_child, ivec3 cell, int level, out int reached) {
    if (own_child == 0u || own_child == NODE_HOLLOW || uvec3(cell >> 1) != own_cell) return brick_of_cell(cell, level, reached);
    reached = level;
    Node child = nodes[child_node(own_child, uvec3(cell))];
    return node_has_brick(child) ? node_brick(child) : NO_BRICK;
}

// One axis of a voxel: column by column along it, then their mean. What stands in one column of a
// thin slanted layer and what stands in the next hide different parts, so that their opacities add.
void filter_axis(uint voxel, uint axis, ivec3 centre, int finer, Cells cells) {
    vec4 plus_side = vec4(0.0);   // as a viewer on the + side sees it
    vec4 minus_side = vec4(0.0);
    for (int i = 0; i < 9; ++i) {
        ivec2 across = ivec2(i % 3, i / 3) - 1;
        vec4 plus_column = vec4(0.0);
        vec4 minus_column = vec4(0.0);
        for (int along = -1; along <= 1; ++along) {
            ivec3 offset = axis == 0u ? ivec3(along, across) : axis == 1u ? ivec3(across.y, along, across.x)
                                                             : ivec3(across, along);
            ivec3 in_cell = ivec3(greaterThanEqual(offset, ivec3(0)));
            int cell = in_cell.x | (in_cell.y << 1) | (in_cell.z << 2);
            uint bit = voxel_of_point(uvec3(offset));
            if ((cells.points[cell] & (1u << bit)) == 0u) continue;
            AxisVoxel v = axis_voxel_at(cells.brick[cell], cells.reached[cell], uvec3(centre + offset), finer, axis);
            plus_column = over(along == 0 ? v.plus_side : half_slab(v.plus_side), plus_column);
            minus_column = over(minus_column, along == 0 ? v.minus_side : half_slab(v.minus_side));
        }
        vec2 weight = vec2(0.5) - 0.25 * vec2(abs(across));
        plus_side += weight.x * weight.y * plus_column;
        minus_side += weight.x * weight.y * minus_column;
    }
    sided[voxel * BRICK_DIRECTIONS + axis * 2u] = pack_half4(plus_side);
    sided[voxel * BRICK_DIRECTIONS + axis * 2u + 1u] = pack_half4(minus_side);
}

void main() {
    uint item = linear_thread_id();
    int level = u_level.level;
    if (item >= octree_state.level_voxels[level].threads) return;
    uint voxel = filtered_voxel_of_item(octree_state.level_first[level], item);
    Brick place = bricks[voxel / BRICK_VOXELS];
    uint octant = voxel % BRICK_VOXELS;
    uvec3 own_cell = unpack_cell(place.cell);
    uint own_child = nodes[place.node & BRICK_NODE_MASK].child;
    ivec3 point = ivec3(own_cell * 2u + (uvec3(octant, octant >> 1, octant >> 2) & 1u));
    int finer = level + 1;  // whose lattice has this voxel at 2 point, between its cells point - 1 and point
    Cells cells;
    for (int i = 0; i < 8; ++i) {
        ivec3 cell = point - 1 + (ivec3(i, i >> 1, i >> 2) & 1);
        cells.brick[i] = finer_brick(own_cell, own_child, cell, finer, cells.reached[i]);
        cells.points[i] = points_of_cell(cells.brick[i], cells.reached[i], finer);
    }
    for (uint axis = 0u; axis < 3u; ++axis) filter_axis(voxel, axis, point * 2, finer, cells);
}
