// evaluate_material: what a material says about a surface point, in the talk's terms. Used by every
// pass that draws meshes. MATERIAL_TEXTURES is the mask of the slots (1 << SLOT_*) that may have a
// texture; the fetches of the others are left out.
#include "shared/gbuffer.glsl"
#include "shared/material.glsl"
#include "lib/brdf.glsl"

#ifndef MATERIAL_TEXTURES
#define MATERIAL_TEXTURES 31
#endif
// 0: every slot reads the first uv set as it is.
#ifndef MATERIAL_UV_TRANSFORMS
#define MATERIAL_UV_TRANSFORMS 1
#endif

// Absent textures are bound to a 1x1 white one (a flat normal for u_normal_texture).
uniform sampler2D u_base_color_texture;          // sRGB
uniform sampler2D u_metallic_roughness_texture;  // g: roughness, b: metallic
uniform sampler2D u_normal_texture;
uniform sampler2D u_occlusion_texture;           // r
uniform sampler2D u_emissive_texture;            // sRGB

// Reflectance of a dielectric at normal incidence, glTF 2.0 appendix B (index of refraction 1.5).
const vec3 DIELECTRIC_SPECULAR = vec3(0.04);

struct Surface {
    vec3 albedo;            // diffuse
    float opacity;
    vec3 specular_color;    // reflectance at normal incidence
    float specular_power;
    vec3 emissive;          // radiance
    float roughness;
    vec3 normal_ts;         // unit
    float ambient_occlusion;
    vec3 subsurface_color;
    uint lighting_model;    // LIGHTING_*
};

// The texel of a slot at a surface point. Gradients come from the interpolated coordinates alone:
// outside the triangle, where the quad's helpers are, llvmpipe reads 0 from buffers, and a
// coordinate transformed there would choose far too coarse a level.
vec4 material_texel(sampler2D image, uint material, uint slot, vec2 uv0, vec2 uv1) {
#if MATERIAL_UV_TRANSFORMS
    bool second = (materials[material].uv_set_mask & (1u << slot)) != 0u;
    vec3 row_u = materials[material].uv_row_u[slot].xyz;
    vec3 row_v = materials[material].uv_row_v[slot].xyz;
    mat2 uv_from_uv = transpose(mat2(row_u.xy, row_v.xy));
    vec2 dx = second ? dFdx(uv1) : dFdx(uv0);
    vec2 dy = second ? dFdy(uv1) : dFdy(uv0);
    vec2 uv = uv_from_uv * (second ? uv1 : uv0) + vec2(row_u.z, row_v.z);
    return textureGrad(image, uv, uv_from_uv * dx, uv_from_uv * dy);
#else
    return texture(image, uv0);
#endif
}

// Only the opacity: for passes that need the alpha test and nothing else.
float material_opacity(uint material, vec2 uv0, vec2 uv1, float vertex_alpha) {
    float opacity = materials[material].base_color.a * vertex_alpha;
#if (MATERIAL_TEXTURES & 1) != 0
    opacity *= material_texel(u_base_color_texture, material, SLOT_BASE_COLOR, uv0, uv1).a;
#endif
    return opacity;
}

// Metallic-roughness to diffuse and specular colour as in glTF 2.0 appendix B ("Material Structure"),
// roughness to specular power in lib/brdf.glsl. vertex_color: linear.
Surface evaluate_material(uint material, vec2 uv0, vec2 uv1, vec4 vertex_color) {
    vec4 base_color = materials[material].base_color * vertex_color;
    float metallic = materials[material].metallic;
    float roughness = materials[material].roughness;
    vec3 emissive = materials[material].emissive;
    Surface s;
    s.normal_ts = vec3(0.0, 0.0, 1.0);
    s.ambient_occlusion = 1.0;
#if (MATERIAL_TEXTURES & 1) != 0
    base_color *= material_texel(u_base_color_texture, material, SLOT_BASE_COLOR, uv0, uv1);
#endif
#if (MATERIAL_TEXTURES & 2) != 0
    vec4 mr = material_texel(u_metallic_roughness_texture, material, SLOT_METALLIC_ROUGHNESS,
                             uv0, uv1);
    roughness *= mr.g;
    metallic *= mr.b;
#endif
#if (MATERIAL_TEXTURES & 4) != 0
    vec3 n = material_texel(u_normal_texture, material, SLOT_NORMAL, uv0, uv1).xyz;
    n = (n * 255.0 - 128.0) / 127.0;  // code 128 is 0: a flat normal map stays flat
    n.xy *= materials[material].normal_scale;
    s.normal_ts = normalize(vec3(n.xy, max(n.z, 1e-3)));
#endif
#if (MATERIAL_TEXTURES & 8) != 0
    float ao = material_texel(u_occlusion_texture, material, SLOT_OCCLUSION, uv0, uv1).r;
    s.ambient_occlusion = 1.0 + materials[material].occlusion_strength * (ao - 1.0);
#endif
#if (MATERIAL_TEXTURES & 16) != 0
    emissive *= material_texel(u_emissive_texture, material, SLOT_EMISSIVE, uv0, uv1).rgb;
#endif
    s.albedo = base_color.rgb * (1.0 - metallic);
    s.opacity = base_color.a;
    s.specular_color = mix(DIELECTRIC_SPECULAR, base_color.rgb, metallic);
    s.roughness = clamp(roughness, 0.0, 1.0);
    s.specular_power = specular_power_from_roughness(s.roughness);
    s.emissive = emissive;
    s.subsurface_color = vec3(0.0);
    s.lighting_model = LIGHTING_DEFAULT;
    if ((materials[material].flags & MATERIAL_UNLIT) != 0u) {  // KHR_materials_unlit
        s.emissive = base_color.rgb;
        s.albedo = vec3(0.0);
        s.specular_color = vec3(0.0);
        s.lighting_model = LIGHTING_UNLIT;
    }
    return s;
}
