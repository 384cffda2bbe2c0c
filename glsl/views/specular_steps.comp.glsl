// How many samples the specular cone of a pixel takes, traced or not; black where it has none.

#include "lib/cone_steps.glsl"
#include "lib/glossy.glsl"
#include "lib/specular_cone.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba8) writeonly uniform image2D o_image;

const float STEPS_WHITE = 192.0;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    GlossySurface s = glossy_surface(pixel);
    if (s.kind == GLOSSY_CONE) specular_cone(s.p_ws, s.normal, s.half_angle);
    imageStore(o_image, pixel, vec4(steps_color(cone_steps, 1, STEPS_WHITE), 1.0));
}
