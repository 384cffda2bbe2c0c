// The slide's append, which also maintains the group count of the dispatch over the list.
// [Mittring12 "Specular Sampling 2/2": saves one pass]

#include "lib/dispatch.glsl"
#include "shared/specular_list.glsl"

uint pixel_code(ivec2 pixel) { return (uint(pixel.y) << 16) | uint(pixel.x); }
ivec2 pixel_of_code(uint code) { return ivec2(code & 0xffffu, code >> 16); }

// Place of the next item of a list; makes its dispatch reach it. A macro: buffers can't be
// arguments.
#define next_item(counts, at) \
    uint at = atomicAdd(counts.listed, 1u); \
    reach_item(counts.groups_x, counts.groups_y, at, SPECULAR_GROUP)

void append_pixel(ivec2 pixel) {
    next_item(specular, at);
    specular_pixels[at] = pixel_code(pixel);
}
