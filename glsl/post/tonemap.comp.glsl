// Exposure, filmic curve, sRGB and dither in one pass.
layout(local_size_x = 8, local_size_y = 8) in;

#include "shared/view.glsl"
#include "lib/tonemap.glsl"

uniform sampler2D u_scene_color;
layout(rgba8) writeonly uniform image2D o_image;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    vec3 radiance = max(texelFetch(u_scene_color, pixel, 0).rgb, vec3(0.0)) * u_view.exposure;
    vec3 display = srgb_encode(filmic_curve(radiance));
    imageStore(o_image, pixel, vec4(display + dither_triangular(uvec2(pixel)) / 255.0, 1.0));
}
