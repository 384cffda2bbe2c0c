// Emissive parallelograms and balls: each pixel of the interleaved 3x3 pattern looks at another part of
// their light, through a cone or in the shadow maps of that part. Maps are looked into so fast that a
// pixel looks at its part of each light that has them. [Mittring12 "Voxel Lighting": shadowed area lights
// from emissive materials], [Segovia06]

#include "lib/area_shadow.glsl"
#include "lib/interleave.glsl"
#include "lib/packing.glsl"
#include "lib/view.glsl"
#include "shared/gbuffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
// Irradiance with shadow; luminance of it without; both by the brightest face's radiance.
layout(rgba16f) writeonly uniform image2D o_irradiance;

// With shadow; luminance without.
vec4 from_sample(vec3 p_ws, vec3 normal, AreaSample s) {
    if (s.face < 0 || dot(s.point_ws - p_ws, normal) <= 0.0) return vec4(0.0);
    float unshadowed = luminance(s.irradiance);
    if (unshadowed <= 0.0) return vec4(0.0);
    return vec4(s.irradiance * area_visibility(p_ws, normal, s), unshadowed);
}

void main() {
    ivec2 size = ivec2(u_view.viewport_px.xy);
    InterleavedPixel own = interleaved_pixel(gl_GlobalInvocationID, size);
    if (!own.inside) return;

    vec4 result = vec4(0.0);
    float depth = texelFetch(u_depth, own.pixel, 0).r;
    if (depth < DEPTH_CLEAR) {
        vec3 normal = normal10_decode(texelFetch(u_gbuffer_a, own.pixel, 0).xyz);
        vec3 p_ws = position_ws_at((vec2(own.pixel) + 0.5) * u_view.viewport_px.zw, depth);
#if AREA_MAPS != NO_AREA_MAPS
        for (int i = 0; i < u_area_lights.count; ++i)
            if (has_maps(i)) result += from_sample(p_ws, normal, sample_part(i, p_ws, normal, own.cone));
#endif
#if AREA_MAPS != ALL_AREA_MAPS
        result += from_sample(p_ws, normal, sample_area_lights(p_ws, normal, own.cone));
#endif
        result *= u_area_lights.inverse_radiance;
    }
    imageStore(o_irradiance, own.texel, result);
}
