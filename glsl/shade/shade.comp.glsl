// Deferred shading: adds direct and indirect light to the emission in scene_color, and the sky
// where nothing is. [Mittring12 "Shading"]
#ifndef SKY
#define SKY 1
#endif
#ifndef DIFFUSE_GI
#define DIFFUSE_GI 1
#endif
#ifndef SPECULAR_GI
#define SPECULAR_GI 1
#endif

layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/direct.glsl"
#include "lib/finite.glsl"
#include "lib/gbuffer.glsl"
#include "lib/view.glsl"
#if SKY
#include "lib/sky.glsl"
#endif

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
uniform sampler2D u_gbuffer_b;
uniform sampler2D u_gbuffer_c;
uniform sampler2D u_gbuffer_d;
#if DIFFUSE_GI
uniform sampler2D u_diffuse_gi;   // irradiance / pi
#endif
#if SPECULAR_GI
uniform sampler2D u_specular_gi;  // radiance along the mirrored eye ray
#endif
layout(rgba16f) uniform image2D u_scene_color;

vec3 shade_surface(GBufferSurface s, vec3 p_ws, ivec2 pixel) {
    ShadingPoint point = seen_point(p_ws, s.normal_ws, s.albedo, s.specular_color,
                                    s.specular_power, s.subsurface_color, s.lighting_model);
    DirectLight direct = direct_light(point);
    vec3 radiance = direct.diffuse + direct.specular;
    vec3 indirect = vec3(0.0);
#if DIFFUSE_GI
    indirect += texelFetch(u_diffuse_gi, pixel, 0).rgb * s.ambient_occlusion
        * (point.albedo + point.subsurface_color);
#endif
#if SPECULAR_GI
    indirect += texelFetch(u_specular_gi, pixel, 0).rgb * s.ambient_occlusion * point.mirrored;
#endif
    return radiance + indirect * u_view.indirect;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    vec2 uv = (vec2(pixel) + 0.5) * u_view.viewport_px.zw;
    float depth = texelFetch(u_depth, pixel, 0).r;
    if (depth == DEPTH_CLEAR) {
#if SKY
        imageStore(u_scene_color, pixel,
                   vec4(min(sky_radiance(eye_ray_ws(uv), 0.0), HALF_MAX), 0.0));
#endif
        return;
    }
    GBufferSurface s = gbuffer_unpack(GBufferTexels(
        texelFetch(u_gbuffer_a, pixel, 0), texelFetch(u_gbuffer_b, pixel, 0),
        texelFetch(u_gbuffer_c, pixel, 0), texelFetch(u_gbuffer_d, pixel, 0)));
    if (s.lighting_model == LIGHTING_UNLIT) return;
    vec4 emission = imageLoad(u_scene_color, pixel);
    vec3 radiance = emission.rgb + shade_surface(s, position_ws_at(uv, depth), pixel);
    imageStore(u_scene_color, pixel, vec4(finite_radiance(radiance), 1.0));
}
