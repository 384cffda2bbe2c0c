// One channel of the G-buffer, by meaning, as display codes.
#ifndef CHANNEL
#define CHANNEL CHANNEL_NORMAL
#endif

layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/false_color.glsl"
#include "lib/gbuffer.glsl"
#include "lib/tonemap.glsl"
#include "lib/view.glsl"

const int CHANNEL_NORMAL = 0;
const int CHANNEL_DIFFUSE = 1;
const int CHANNEL_SPECULAR = 2;
const int CHANNEL_SPECULAR_POWER = 3;
const int CHANNEL_AO = 4;
const int CHANNEL_DEPTH = 5;
const int CHANNEL_LIGHTING_MODEL = 6;
const int CHANNEL_SUBSURFACE = 7;
const int CHANNEL_DECAL_MASK = 8;

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
uniform sampler2D u_gbuffer_b;
uniform sampler2D u_gbuffer_c;
uniform sampler2D u_gbuffer_d;
layout(rgba8) writeonly uniform image2D o_image;

vec3 channel_color(GBufferSurface s, float depth) {
    if (CHANNEL == CHANNEL_NORMAL) return s.normal_ws * 0.5 + 0.5;
    if (CHANNEL == CHANNEL_DIFFUSE) return srgb_encode(s.albedo);
    if (CHANNEL == CHANNEL_SPECULAR) return srgb_encode(s.specular_color);
    if (CHANNEL == CHANNEL_SPECULAR_POWER)
        return false_color(specular_power_encode(s.specular_power));
    if (CHANNEL == CHANNEL_AO) return vec3(s.ambient_occlusion);
    if (CHANNEL == CHANNEL_DECAL_MASK) return vec3(s.decal_mask);
    if (CHANNEL == CHANNEL_SUBSURFACE) return srgb_encode(s.subsurface_color);
    if (CHANNEL == CHANNEL_LIGHTING_MODEL)
        return false_color(float(s.lighting_model) / LIGHTING_MODEL_SCALE);
    // Near is bright: logarithmic over the camera's range, so that both ends can be told apart.
    float distance_m = linear_depth(depth);
    return false_color(1.0 - log(distance_m / u_view.near) / log(u_view.far / u_view.near));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    float depth = texelFetch(u_depth, pixel, 0).r;
    vec3 color = vec3(0.0);
    if (depth != DEPTH_CLEAR) {
        GBufferSurface s = gbuffer_unpack(GBufferTexels(
            texelFetch(u_gbuffer_a, pixel, 0), texelFetch(u_gbuffer_b, pixel, 0),
            texelFetch(u_gbuffer_c, pixel, 0), texelFetch(u_gbuffer_d, pixel, 0)));
        color = channel_color(s, depth);
    }
    imageStore(o_image, pixel, vec4(color, 1.0));
}
