// The G-buffer's texels and what they stand for. [Mittring12 "GBuffer" table]
#include "shared/gbuffer.glsl"
#include "lib/brdf.glsl"
#include "lib/packing.glsl"

struct GBufferSurface {
    vec3 normal_ws;
    uint lighting_model;    // LIGHTING_*
    vec3 specular_color;
    float ambient_occlusion;
    vec3 albedo;
    float decal_mask;       // 1: decals may draw here
    float specular_power;
    vec3 subsurface_color;
};

struct GBufferTexels {
    vec4 a;  // RGB10_A2: world normal, lighting model
    vec4 b;  // RGBA8: specular colour, ambient occlusion
    vec4 c;  // RGBA8: diffuse colour, opacity or decal mask
    vec4 d;  // RGBA8: specular power, subsurface colour
};

const float LIGHTING_MODEL_SCALE = 3.0;  // largest code of two bits

// Colours are stored as square roots: 8 linear bits would band in the dark [inferred: the table
// gives the format, not the transfer curve].
GBufferTexels gbuffer_pack(GBufferSurface s) {
    GBufferTexels t;
    t.a = vec4(normal10_encode(s.normal_ws), float(s.lighting_model) / LIGHTING_MODEL_SCALE);
    t.b = vec4(sqrt(clamp(s.specular_color, 0.0, 1.0)), s.ambient_occlusion);
    t.c = vec4(sqrt(clamp(s.albedo, 0.0, 1.0)), s.decal_mask);
    t.d = vec4(specular_power_encode(s.specular_power), sqrt(clamp(s.subsurface_color, 0.0, 1.0)));
    return t;
}

GBufferSurface gbuffer_unpack(GBufferTexels t) {
    GBufferSurface s;
    s.normal_ws = normal10_decode(t.a.xyz);
    s.lighting_model = uint(t.a.w * LIGHTING_MODEL_SCALE + 0.5);
    s.specular_color = t.b.rgb * t.b.rgb;
    s.ambient_occlusion = t.b.a;
    s.albedo = t.c.rgb * t.c.rgb;
    s.decal_mask = t.c.a;
    s.specular_power = specular_power_decode(t.d.r);
    s.subsurface_color = t.d.gba * t.d.gba;
    return s;
}
