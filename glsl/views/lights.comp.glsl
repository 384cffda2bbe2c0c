// What the lights alone do: their visibility, or the radiance that they add.
#ifndef SHOW_RADIANCE
#define SHOW_RADIANCE 0
#endif

layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/direct.glsl"
#include "lib/gbuffer.glsl"
#include "lib/view.glsl"

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
uniform sampler2D u_gbuffer_b;
uniform sampler2D u_gbuffer_c;
uniform sampler2D u_gbuffer_d;
layout(rgba16f) writeonly uniform image2D o_image;

// Share of the unshadowed irradiance that arrives; 0 where no light could reach the surface anyway.
vec3 visibility(ShadingPoint point) {
    vec3 arriving = vec3(0.0);
    vec3 unshadowed = vec3(0.0);
    float footprint_m = pixel_width_m(point.p_ws);
    for (LightWalk walk = first_light(point.p_ws); walk.light < light_count(); next_light(walk)) {
        LightSample s = sample_light(lights[walk.light], point.p_ws, footprint_m);
        vec3 irradiance = s.irradiance * max(dot(point.n_ws, s.to_light), 0.0);
        if (max(irradiance.r, max(irradiance.g, irradiance.b)) <= 0.0) continue;
        unshadowed += irradiance;
        arriving += irradiance * light_visibility_in_view(walk.light, point.p_ws, point.n_ws);
    }
    return arriving / max(unshadowed, vec3(1e-30));
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
        vec3 p_ws = position_ws_at((vec2(pixel) + 0.5) * u_view.viewport_px.zw, depth);
        ShadingPoint point = seen_point(p_ws, s.normal_ws, s.albedo, s.specular_color,
                                        s.specular_power, s.subsurface_color, s.lighting_model);
#if SHOW_RADIANCE
        DirectLight direct = direct_light(point);
        color = s.lighting_model == LIGHTING_UNLIT ? vec3(0.0) : direct.diffuse + direct.specular;
#else
        color = visibility(point);
#endif
    }
    imageStore(o_image, pixel, vec4(color, 1.0));
}
