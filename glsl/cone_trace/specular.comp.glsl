// One cone a pixel along the mirrored eye vector. [Mittring12 "Specular Sampling 1/2"]

#include "lib/cone.glsl"
#include "lib/brdf.glsl"
#include "lib/packing.glsl"
#include "lib/sky.glsl"
#include "lib/view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
uniform sampler2D u_gbuffer_b;
uniform sampler2D u_gbuffer_d;
uniform sampler2D u_diffuse_gi;
layout(rgba16f) writeonly uniform image2D o_specular_gi;

// Finest voxels off the surface along the normal, and along the cone.
const float SPECULAR_NORMAL_BIAS = 1.0;
const float SPECULAR_START = 1.0;
const float SPECULAR_VISIBLE = 1.0 / 512.0;  // reflectance below this is not traced
// A lobe this wide on a surface this dim takes what the diffuse cones gathered. [Mittring12
// "Specular Sampling 1/2": adaptive by specular brightness]
const float BROAD_HALF_ANGLE = 0.7;  // radians
const float DIM_REFLECTANCE = 0.08;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    float depth = texelFetch(u_depth, pixel, 0).r;
    vec3 color = texelFetch(u_gbuffer_b, pixel, 0).rgb;
    float reflectance = max(color.r, max(color.g, color.b));
    if (depth >= 1.0 || reflectance < SPECULAR_VISIBLE) {
        imageStore(o_specular_gi, pixel, vec4(0.0, 0.0, 0.0, 1.0));
        return;
    }
    float power = specular_power_decode(texelFetch(u_gbuffer_d, pixel, 0).r);
    float half_angle = specular_cone_half_angle(power);
    if (half_angle > BROAD_HALF_ANGLE && reflectance < DIM_REFLECTANCE) {
        imageStore(o_specular_gi, pixel, texelFetch(u_diffuse_gi, pixel, 0));
        return;
    }
    vec3 normal = normal10_decode(texelFetch(u_gbuffer_a, pixel, 0).xyz);
    vec3 p_ws = position_ws_at((vec2(pixel) + 0.5) * u_view.viewport_px.zw, depth);
    vec3 eye = normalize(p_ws - u_view.eye_ws);
    vec3 direction = reflect(eye, normal);
    // A mirrored ray of a shading normal may point into the surface.
    direction = normalize(direction + normal * max(0.0, 0.02 - dot(direction, normal)));
    vec3 origin = p_ws + normal * (SPECULAR_NORMAL_BIAS * u_octree.voxel_m);
    vec4 cone = cone_trace_from(origin, direction, half_angle, SPECULAR_START * u_octree.voxel_m);
    float visible = 1.0 - cone.a;
    vec3 radiance = cone.rgb + visible * sky_radiance(direction, half_angle);
    imageStore(o_specular_gi, pixel, vec4(radiance, visible));
}
