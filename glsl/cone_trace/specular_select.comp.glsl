// Settles the pixels that need no specular cone and lists the others: those traced first, and those
// that may do with their neighbours'.
// [Mittring12 "Specular Sampling 1/2": adaptive by specular brightness]
#ifndef ADAPTIVE
#define ADAPTIVE 1  // 0: all are traced first
#endif

#include "lib/glossy.glsl"
#include "lib/show_traced.glsl"
#include "lib/specular_append.glsl"
#include "lib/specular_grid.glsl"
#if ADAPTIVE
#include "shared/undecided_list.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_broad_gi;
layout(rgba16f) writeonly uniform image2D o_specular_gi;

void main() {
    ivec2 size = ivec2(u_view.viewport_px.xy);
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size))) return;
    uint kind = glossy_surface(pixel).kind;
    if (kind != GLOSSY_CONE) {
        bool broad = kind == GLOSSY_BROAD;
        vec4 light = broad ? texelFetch(u_broad_gi, pixel, 0) : vec4(0.0, 0.0, 0.0, 1.0);
        imageStore(o_specular_gi, pixel, light);
        show_traced(pixel, SHOW_NONE);
        return;
    }
#if ADAPTIVE
    if (!in_coarse_grid(pixel, size)) {
        next_item(undecided, at);
        undecided_pixels[at] = pixel_code(pixel);
        return;
    }
#endif
    append_pixel(pixel);
    show_traced(pixel, SHOW_COARSE);
}
