// One word of one cell: which of 32 lights may reach it.
#include "shared/light_cell_kinds.glsl"
#ifndef LIGHT_CELLS
#define LIGHT_CELLS VIEW_CELLS
#endif

#include "lib/dispatch.glsl"
#include "shared/light_bounds.glsl"
#include "shared/light_cells.glsl"
#if LIGHT_CELLS == VIEW_CELLS
#include "shared/view.glsl"
#endif

layout(local_size_x = 64) in;

layout(r32ui) writeonly uniform uimage2D o_light_bits;

// What a cell is grown by, of its size: a point on its rim may round into its neighbour.
const float CELL_SLACK = 1e-3;

struct Box {
    vec3 center;
    vec3 half_size;
};

#if LIGHT_CELLS == VIEW_CELLS
// Where a slice begins, m of depth.
float slice_depth(uint slice) {
    if (slice == 0u) return 0.0;
    return u_light_cells.first_depth_m * exp2(float(slice - 1u) / u_light_cells.slices_an_octave);
}

// Of a piece of the view's pyramid, in view space.
Box box_of_cell(uvec3 cell) {
    float near = slice_depth(cell.z);
    float far = slice_depth(cell.z + 1u);
    vec2 side = 2.0 * u_light_cells.tangents / vec2(u_light_cells.count.xy);
    vec2 low = side * vec2(cell.xy) - u_light_cells.tangents;
    vec2 high = low + side;
    vec3 low_vs = vec3(min(low * near, low * far), -far);
    vec3 high_vs = vec3(max(high * near, high * far), -near);
    return Box((low_vs + high_vs) * 0.5, (high_vs - low_vs) * (0.5 + CELL_SLACK));
}

vec3 cell_space(vec3 p_ws) { return (u_view.view_from_world * vec4(p_ws, 1.0)).xyz; }
#else
Box box_of_cell(uvec3 cell) {
    vec3 center = u_light_cells.origin_ws + (vec3(cell) + 0.5) * u_light_cells.cell_m;
    return Box(center, vec3(u_light_cells.cell_m * (0.5 + CELL_SLACK)));
}

vec3 cell_space(vec3 p_ws) { return p_ws; }
#endif

bool meets(Box box, vec4 sphere) {
    vec3 outside = max(abs(cell_space(sphere.xyz) - box.center) - box.half_size, vec3(0.0));
    return dot(outside, outside) <= sphere.w * sphere.w;
}

void main() {
    uint index = linear_thread_id();
    uint cell = index / u_light_cells.words;
    uint word = index % u_light_cells.words;
    uvec3 count = u_light_cells.count;
    if (cell >= count.x * count.y * count.z) return;
    uint row = cell / count.x;
    Box box = box_of_cell(uvec3(cell % count.x, row % count.y, row / count.y));
    uint end = min(32u, uint(light_bounds.length()) - 32u * word);
    uint bits = 0u;
    for (uint i = 0u; i < end; ++i) {
        vec4 sphere = light_bounds[32u * word + i];
        if (sphere.w < 0.0 || meets(box, sphere)) bits |= 1u << i;
    }
    imageStore(o_light_bits, light_word_texel(index), uvec4(bits));
}
