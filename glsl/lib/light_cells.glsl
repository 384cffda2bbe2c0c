// Which of the lights may reach a point. Shaders go over them by
//     for (LightWalk walk = first_light(p_ws); walk.light < light_count(); next_light(walk)) ...
// in the order of their numbers. LIGHT_CELLS says among which; with VIEW_CELLS shared/view.glsl
// comes first.
#include "shared/light.glsl"
#include "shared/light_cell_kinds.glsl"

#ifndef LIGHT_CELLS
#define LIGHT_CELLS ALL_LIGHTS
#endif

#if LIGHT_CELLS != ALL_LIGHTS
#include "shared/light_cells.glsl"

uniform usampler2D u_light_bits;

#if LIGHT_CELLS == VIEW_CELLS
// Cell of a point that the camera sees.
uvec3 light_cell_at(vec3 p_ws) {
    vec4 p_cs = u_view.clip_from_world * vec4(p_ws, 1.0);
    vec2 tile = (p_cs.xy / p_cs.w * 0.5 + 0.5) * vec2(u_light_cells.count.xy);
    float octaves = log2(max(p_cs.w / u_light_cells.first_depth_m, 1e-6));
    float slice = max(octaves * u_light_cells.slices_an_octave + 1.0, 0.0);
    return uvec3(clamp(vec3(tile, slice), vec3(0.0), vec3(u_light_cells.count) - 1.0));
}
#else
uvec3 light_cell_at(vec3 p_ws) {
    vec3 cell = (p_ws - u_light_cells.origin_ws) / u_light_cells.cell_m;
    return uvec3(clamp(cell, vec3(0.0), vec3(u_light_cells.count) - 1.0));
}
#endif

uint light_cell(vec3 p_ws) {
    uvec3 cell = light_cell_at(p_ws);
    return cell.x + u_light_cells.count.x * (cell.y + u_light_cells.count.y * cell.z);
}

// Lights 32 * word and on, a bit each.
uint light_bits(uint cell, uint word) {
    return texelFetch(u_light_bits, light_word_texel(cell * u_light_cells.words + word), 0).r;
}
#endif

uint light_count() { return uint(lights.length()); }

struct LightWalk {
    uint light;  // light_count() or more at the end
#if LIGHT_CELLS != ALL_LIGHTS
    uint cell;
    uint word;
    uint bits;  // of the word, of the lights to come
#endif
};

#if LIGHT_CELLS != ALL_LIGHTS
void next_light(inout LightWalk walk) {
    while (walk.bits == 0u && ++walk.word < u_light_cells.words)
        walk.bits = light_bits(walk.cell, walk.word);
    walk.light = walk.bits == 0u ? light_count() : 32u * walk.word + uint(findLSB(walk.bits));
    walk.bits &= walk.bits - 1u;
}

LightWalk first_light(vec3 p_ws) {
    uint cell = light_cell(p_ws);
    LightWalk walk = LightWalk(0u, cell, 0u, light_bits(cell, 0u));
    next_light(walk);
    return walk;
}
#else
void next_light(inout LightWalk walk) { ++walk.light; }

LightWalk first_light(vec3 p_ws) { return LightWalk(0u); }
#endif
