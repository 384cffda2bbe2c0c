// Indirect light from behind what light shines through: nine cones around the turned normal, at the
// pixels of the subsurface lighting model alone. Half of what such a surface sends out comes from
// there; shading took all of it from before.

#include "lib/diffuse_cone.glsl"
#include "lib/lighting_models.glsl"
#include "lib/gbuffer.glsl"
#include "lib/view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
uniform sampler2D u_gbuffer_b;
uniform sampler2D u_gbuffer_c;
uniform sampler2D u_gbuffer_d;
uniform sampler2D u_diffuse_gi;  // irradiance / pi from before
layout(rgba16f) uniform image2D u_scene_color;

// [inferred: light that has lost its way leaves on both sides alike]
const float SHARE_FROM_BEHIND = 0.5;

// Irradiance / pi on the side away from the normal.
vec3 irradiance_behind(vec3 p_ws, vec3 normal) {
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int cone = 0; cone < 9; ++cone) {
        vec4 traced = diffuse_cone(p_ws, -normal, cone);
        if (traced.a == REJECTED) continue;
        float weight = cone_group_weight(-normal, cone);
        sum += weight * traced.rgb;
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : vec3(0.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    float depth = texelFetch(u_depth, pixel, 0).r;
    if (depth == DEPTH_CLEAR) return;
    GBufferSurface s = gbuffer_unpack(GBufferTexels(
        texelFetch(u_gbuffer_a, pixel, 0), texelFetch(u_gbuffer_b, pixel, 0),
        texelFetch(u_gbuffer_c, pixel, 0), texelFetch(u_gbuffer_d, pixel, 0)));
    if (s.lighting_model != LIGHTING_SUBSURFACE || s.subsurface_color == vec3(0.0)) return;
    vec3 p_ws = position_ws_at((vec2(pixel) + 0.5) * u_view.viewport_px.zw, depth);
    vec3 to_eye = normalize(u_view.eye_ws - p_ws);
    ShadingPoint point = shading_point(p_ws, s.normal_ws, to_eye, s.albedo, s.specular_color,
                                       s.specular_power, s.subsurface_color, s.lighting_model);
    vec3 before = texelFetch(u_diffuse_gi, pixel, 0).rgb;
    vec3 change = SHARE_FROM_BEHIND * (irradiance_behind(p_ws, s.normal_ws) - before);
    vec4 color = imageLoad(u_scene_color, pixel);
    color.rgb += change * point.subsurface_color * s.ambient_occlusion * u_view.indirect;
    imageStore(u_scene_color, pixel, vec4(clamp(color.rgb, 0.0, HALF_MAX), color.a));
}
