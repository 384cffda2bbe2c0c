// One translucent surface, lit like the opaque ones and by cones of its own, over what is behind it
// (premultiplied). What passes through glass is bent, tinted and blurred. [Mittring12 "GBuffer":
// one forward pass]
#ifndef GI
#define GI 1
#endif
#ifndef TRANSMISSION
#define TRANSMISSION 1
#endif
#define CONE_SPLIT 1

#include "lib/direct.glsl"
#include "lib/finite.glsl"
#include "lib/material.glsl"
#include "lib/sky.glsl"
#include "lib/tangent_space.glsl"
#include "lib/view.glsl"
#if GI
#include "lib/gathered_light.glsl"
#endif
#if TRANSMISSION
#include "lib/behind.glsl"
#include "lib/refraction.glsl"
#endif

in vec3 v_position_ws;
in vec3 v_normal_ws;
in vec4 v_tangent_ws;
in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
flat in uint v_material;
flat in float v_scale;

layout(location = 0) out vec4 o_radiance;

// Shares of light that reach the eye below this are not worth a cone.
const float VISIBLE_SHARE = 1.0 / 512.0;

vec3 indirect_light(ShadingPoint p, float opacity) {
    float half_angle = specular_cone_half_angle(p.specular_power);
    vec3 indirect = vec3(0.0);
#if GI
    vec3 scattered = p.albedo + p.subsurface_color;
    if (opacity * largest(scattered) > VISIBLE_SHARE)
        indirect += scattered * gathered_diffuse(p.p_ws, p.n_ws);
    if (opacity * largest(p.mirrored) > VISIBLE_SHARE) {
        indirect += p.mirrored * specular_cone(p.p_ws, p.n_ws, half_angle).rgb;
    }
#endif
    return indirect * u_view.indirect;
}

#if TRANSMISSION
// Radius of curvature from how the normal changes from pixel to pixel, m.
float curvature_radius(vec3 normal, vec3 p_ws) {
    vec3 turn = abs(dFdx(normal)) + abs(dFdy(normal));
    vec3 way = abs(dFdx(p_ws)) + abs(dFdy(p_ws));
    return length(way) / max(length(turn), 1e-6);
}

// What a body does to a ray that meets it.
struct Transmission {
    RefractedRay ray;
    PaneShares shares;
};

// mirrored: share of one face. Of a pane both faces mirror what the eye sees in the first one; what
// the far side of a ball mirrors goes elsewhere, and what it loses there arrives from elsewhere,
// too.
Transmission transmission_of(Surface s, ShadingPoint p, float radius_m) {
    float thickness_m = gl_FrontFacing ? s.thickness * v_scale : 0.0;
    float roundness = roundness_of(thickness_m, radius_m);
    RefractedRay ray = refract_through(p.p_ws, -p.to_eye, p.n_ws, s.ior, thickness_m, roundness);
    vec3 kept = exp(-s.absorption * ray.path_m);
    PaneShares pane = pane_shares(p.mirrored, s.transmission * kept);
    PaneShares body = PaneShares(p.mirrored, s.transmission * kept * max(1.0 - p.mirrored, 0.0));
    bool inner = !gl_FrontFacing;  // its mirror image is the front's
    return Transmission(ray, PaneShares(mix(pane.mirrored, body.mirrored, inner ? 1.0 : roundness),
                                        mix(pane.passes, body.passes, inner ? 1.0 : roundness)));
}

// What comes along a ray, without the surface's own colour.
vec3 transmitted_light(Surface s, ShadingPoint p, RefractedRay ray) {
    float half_angle = refracted_half_angle(specular_cone_half_angle(p.specular_power), s.ior);
    vec4 seen = radiance_behind(ray.origin, ray.direction, half_angle);
    if (seen.a >= 1.0) return seen.rgb;
#if GI
    vec3 beside = gathered_radiance(ray.origin, ray.direction, half_angle);
#else
    vec3 beside = sky_radiance(ray.direction, half_angle);
#endif
    return mix(beside, seen.rgb, seen.a);
}
#endif

void main() {
    float facing = gl_FrontFacing ? 1.0 : -1.0;
    Surface s = evaluate_material(MaterialInput(v_material, v_position_ws,
        normalize(v_normal_ws) * facing, v_uv0, v_uv1, v_color, u_material.time_s));
    vec3 n_ws = surface_normal(s, v_normal_ws, v_tangent_ws, facing);
    vec3 p_ws = position_ws_at(gl_FragCoord.xy * u_view.viewport_px.zw, gl_FragCoord.z);
#if TRANSMISSION
    float radius_m = curvature_radius(normalize(v_normal_ws), v_position_ws);
#endif
    vec3 radiance = s.emissive;
    if (s.lighting_model != LIGHTING_UNLIT) {
        ShadingPoint point = seen_point(p_ws, n_ws, s.albedo, s.specular_color, s.specular_power,
                                        s.subsurface_color, s.lighting_model);
        DirectLight direct = direct_light(point);
#if TRANSMISSION
        Transmission through = transmission_of(s, point, radius_m);
        vec3 passes = through.shares.passes;
        if (largest(passes) > VISIBLE_SHARE)
            radiance += passes * transmitted_light(s, point, through.ray);
        direct.specular *= through.shares.mirrored / max(point.mirrored, 1e-4);
        point.mirrored = through.shares.mirrored;
#endif
        radiance += direct.diffuse + direct.specular;
        radiance += indirect_light(point, s.opacity) * s.ambient_occlusion;
    }
    o_radiance = vec4(finite_radiance(radiance) * s.opacity, s.opacity);
}
