// Lists the pixels whose specular cones are traced first: of each coarse cell one, if it is glossy.
// [Mittring12 "Specular Sampling 1/2": adaptive for better performance]

#include "lib/glossy.glsl"
#include "lib/specular_append.glsl"
#include "lib/specular_grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    ivec2 size = ivec2(u_view.viewport_px.xy);
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, coarse_size(size)))) return;
    ivec2 pixel = coarse_pixel(cell, size);
    if (glossy_surface(pixel).kind == GLOSSY_CONE) append_pixel(pixel);
}
