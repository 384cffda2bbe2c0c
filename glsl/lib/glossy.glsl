// What a pixel's surface asks of the specular passes. [Mittring12 "Specular Sampling 1/2"]

#include "lib/brdf.glsl"
#include "lib/packing.glsl"
#include "lib/view.glsl"
#include "shared/gbuffer.glsl"

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
uniform sampler2D u_gbuffer_b;
uniform sampler2D u_gbuffer_d;

const uint GLOSSY_NOTHING = 0u;  // no surface, or one that mirrors too little to see
const uint GLOSSY_BROAD = 1u;    // what the diffuse cones gathered serves
const uint GLOSSY_CONE = 2u;     // a cone of its own, or its neighbours'

const float SPECULAR_VISIBLE = 1.0 / 512.0;  // reflectance below this is not traced
// A lobe this wide on a surface this dim takes what the diffuse cones gathered.
const float BROAD_HALF_ANGLE = 0.7;  // radians
const float DIM_REFLECTANCE = 0.08;

struct GlossySurface {
    uint kind;  // GLOSSY_*; the rest counts for GLOSSY_CONE alone
    vec3 p_ws;
    vec3 normal;
    vec3 specular_color;
    float power;
    float half_angle;  // of the cone, radians
};

GlossySurface glossy_surface(ivec2 pixel) {
    GlossySurface s;
    s.kind = GLOSSY_NOTHING;
    float depth = texelFetch(u_depth, pixel, 0).r;
    vec3 root = texelFetch(u_gbuffer_b, pixel, 0).rgb;  // colours are stored as square roots
    s.specular_color = root * root;
    float reflectance = max(s.specular_color.r, max(s.specular_color.g, s.specular_color.b));
    if (depth >= DEPTH_CLEAR || reflectance < SPECULAR_VISIBLE) return s;
    s.power = specular_power_decode(texelFetch(u_gbuffer_d, pixel, 0).r);
    s.half_angle = specular_cone_half_angle(s.power);
    s.kind = GLOSSY_BROAD;
    if (s.half_angle > BROAD_HALF_ANGLE && reflectance < DIM_REFLECTANCE) return s;
    s.kind = GLOSSY_CONE;
    s.normal = normal10_decode(texelFetch(u_gbuffer_a, pixel, 0).xyz);
    s.p_ws = position_ws_at((vec2(pixel) + 0.5) * u_view.viewport_px.zw, depth);
    return s;
}
