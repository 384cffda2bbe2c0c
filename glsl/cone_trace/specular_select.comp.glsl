// Which pixels need a specular cone of their own; the others are settled here.
// [Mittring12 "Specular Sampling": adaptive by specular brightness; an append that also maintains the
// group count saves one pass]

#include "lib/dispatch.glsl"
#include "lib/brdf.glsl"
#include "shared/gbuffer.glsl"
#include "shared/specular_list.glsl"
#include "shared/view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_b;
uniform sampler2D u_gbuffer_d;
uniform sampler2D u_diffuse_gi;
layout(rgba16f) writeonly uniform image2D o_specular_gi;

const float SPECULAR_VISIBLE = 1.0 / 512.0;  // reflectance below this is not traced
// A lobe this wide on a surface this dim takes what the diffuse cones gathered.
const float BROAD_HALF_ANGLE = 0.7;  // radians
const float DIM_REFLECTANCE = 0.08;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    vec3 root = texelFetch(u_gbuffer_b, pixel, 0).rgb;  // colours are stored as square roots
    float largest_root = max(root.r, max(root.g, root.b));
    float reflectance = largest_root * largest_root;
    if (texelFetch(u_depth, pixel, 0).r >= DEPTH_CLEAR || reflectance < SPECULAR_VISIBLE) {
        imageStore(o_specular_gi, pixel, vec4(0.0, 0.0, 0.0, 1.0));
        return;
    }
    float half_angle = specular_cone_half_angle(specular_power_decode(texelFetch(u_gbuffer_d, pixel, 0).r));
    if (half_angle > BROAD_HALF_ANGLE && reflectance < DIM_REFLECTANCE) {
        imageStore(o_specular_gi, pixel, texelFetch(u_diffuse_gi, pixel, 0));
        return;
    }
    uint at = atomicAdd(specular_list.count, 1u);
    reach_item(specular_list.groups_x, specular_list.groups_y, at, SPECULAR_GROUP);
    specular_list.pixels[at] = (uint(pixel.y) << 16) | uint(pixel.x);
}
