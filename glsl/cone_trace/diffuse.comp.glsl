// Nine sub-images, one direction each, so that neighbouring threads walk the same way.
// [Mittring12 "Diffuse Sampling 2/2"], [Segovia06]: non-interleaved processing of an interleaved
// 3x3 pattern; loop over 9 directions, then XY; reject samples behind the surface normal.
//
// SHARED: each pixel traces one of its group's CONE_SPLIT cones, four of them, and
// cone_trace/share.comp.glsl makes the group's mean.

#ifndef SHARED
#define SHARED 0
#endif

#include "lib/diffuse_cone.glsl"
#include "lib/packing.glsl"
#include "lib/view.glsl"
#include "lib/interleave.glsl"
#include "shared/gbuffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
layout(rgba16f) writeonly uniform image2D o_radiance;

void main() {
    ivec2 size = ivec2(u_view.viewport_px.xy);
#if SHARED
    int part;
    InterleavedPixel own = interleaved_part(gl_GlobalInvocationID, size, part);
#else
    InterleavedPixel own = interleaved_pixel(gl_GlobalInvocationID, size);
#endif
    if (!own.inside) return;

    vec4 result = vec4(0.0, 0.0, 0.0, REJECTED);
    float depth = texelFetch(u_depth, own.pixel, 0).r;
    if (depth < DEPTH_CLEAR) {
        vec3 normal = normal10_decode(texelFetch(u_gbuffer_a, own.pixel, 0).xyz);
        vec3 p_ws = position_ws_at((vec2(own.pixel) + 0.5) * u_view.viewport_px.zw, depth);
#if SHARED
        result = diffuse_cone_part(p_ws, normal, own.cone, part);
#else
        result = diffuse_cone(p_ws, normal, own.cone);
#endif
    }
    imageStore(o_radiance, own.texel, min(result, HALF_MAX));
}
