// One cone a listed pixel along the mirrored eye vector, scattered into the picture.
// [Mittring12 "Specular Sampling 1/2", "2/2"]

#include "lib/glossy.glsl"
#include "lib/specular_append.glsl"
#include "lib/specular_cone.glsl"

layout(local_size_x = 64) in;

layout(rgba16f) writeonly uniform image2D o_specular_gi;

void main() {
    uint item = linear_thread_id();
    if (item >= specular.listed) return;
    ivec2 pixel = pixel_of_code(specular_pixels[item]);
    GlossySurface s = glossy_surface(pixel);
    imageStore(o_specular_gi, pixel, min(specular_cone(s.p_ws, s.normal, s.half_angle), HALF_MAX));
}
