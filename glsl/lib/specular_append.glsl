// The slide's append, which also maintains the group count of the dispatch over the list.
// [Mittring12 "Specular Sampling 2/2": saves one pass]

#include "lib/dispatch.glsl"
#include "shared/specular_list.glsl"
#include "shared/specular_state.glsl"

void append_pixel(ivec2 pixel) {
    uint at = atomicAdd(specular.listed, 1u);
    reach_item(specular.groups_x, specular.groups_y, at, SPECULAR_GROUP);
    specular_pixels[at] = (uint(pixel.y) << 16) | uint(pixel.x);
}
