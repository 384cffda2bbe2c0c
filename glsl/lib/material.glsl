// evaluate_material: what a material says about a surface point, in the talk's terms. Used by every
// pass that draws meshes. [Mittring12 "Voxel Lighting Pipeline": artist defined material]
//
// A description with snippets={"material": ...} puts the artist's code where <material> is
// included; without one the material is glTF's. MATERIAL_TEXTURES is the mask of the glTF slots (1
// << SLOT_*) that may have a texture; the fetches of the others are left out. MATERIAL_FAULTS 1: a
// surface that is no number is shown as the fallback, and told in the buffer MaterialFaults.
#include "shared/material.glsl"
#include "lib/finite.glsl"
#include "lib/refraction.glsl"
#include "lib/surface.glsl"

#ifndef MATERIAL_TEXTURES
#define MATERIAL_TEXTURES 31
#endif
// 0: every slot reads the first uv set as it is.
#ifndef MATERIAL_UV_TRANSFORMS
#define MATERIAL_UV_TRANSFORMS 1
#endif
#ifndef MATERIAL_FAULTS
#define MATERIAL_FAULTS 0
#endif

// Absent textures are bound to a 1x1 white one (a flat normal for u_normal_texture).
uniform sampler2D u_base_color_texture;          // sRGB
uniform sampler2D u_metallic_roughness_texture;  // g: roughness, b: metallic
uniform sampler2D u_normal_texture;
uniform sampler2D u_occlusion_texture;           // r
uniform sampler2D u_emissive_texture;            // sRGB

#if MATERIAL_FAULTS
layout(std430) buffer MaterialFaults { uint material_faults[]; };  // by material: 1 where one was
#endif

// How texture coordinates change from pixel to pixel; a pass that knows better defines its own.
#ifndef MATERIAL_UV_DX
#define MATERIAL_UV_DX(uv) dFdx(uv)
#define MATERIAL_UV_DY(uv) dFdy(uv)
#else
#define MATERIAL_UV_GIVEN 1
#endif

// The texel of a slot at a surface point. Gradients come from the interpolated coordinates alone:
// outside the triangle, where the quad's helpers are, llvmpipe reads 0 from buffers, and a
// coordinate transformed there would choose far too coarse a level.
vec4 material_texel(sampler2D image, uint material, uint slot, vec2 uv0, vec2 uv1) {
#if MATERIAL_UV_TRANSFORMS
    bool second = (materials[material].uv_set_mask & (1u << slot)) != 0u;
    vec3 row_u = materials[material].uv_row_u[slot].xyz;
    vec3 row_v = materials[material].uv_row_v[slot].xyz;
    mat2 uv_from_uv = transpose(mat2(row_u.xy, row_v.xy));
    vec2 dx = second ? MATERIAL_UV_DX(uv1) : MATERIAL_UV_DX(uv0);
    vec2 dy = second ? MATERIAL_UV_DY(uv1) : MATERIAL_UV_DY(uv0);
    vec2 uv = uv_from_uv * (second ? uv1 : uv0) + vec2(row_u.z, row_v.z);
    return textureGrad(image, uv, uv_from_uv * dx, uv_from_uv * dy);
#elif defined(MATERIAL_UV_GIVEN)
    return textureGrad(image, uv0, MATERIAL_UV_DX(uv0), MATERIAL_UV_DY(uv0));
#else
    return texture(image, uv0);
#endif
}

// glTF's base colour and opacity: factor, texture and the vertex's colour.
vec4 base_color_of(MaterialInput m) {
    vec4 base_color = materials[m.material].base_color * m.color;
#if (MATERIAL_TEXTURES & 1) != 0
    base_color *= material_texel(u_base_color_texture, m.material, SLOT_BASE_COLOR, m.uv0, m.uv1);
#endif
    return base_color;
}

// glTF's material: metallic-roughness to diffuse and specular colour as in glTF 2.0 appendix B
// ("Material Structure"), and what KHR_materials_transmission, _ior and _volume add.
Surface standard_surface(MaterialInput m) {
    vec4 base_color = base_color_of(m);
    float metallic = materials[m.material].metallic;
    Surface s = plain_surface();
    s.roughness = materials[m.material].roughness;
    s.emissive = materials[m.material].emissive;
#if (MATERIAL_TEXTURES & 2) != 0
    vec4 mr = material_texel(u_metallic_roughness_texture, m.material, SLOT_METALLIC_ROUGHNESS,
                             m.uv0, m.uv1);
    s.roughness *= mr.g;
    metallic *= mr.b;
#endif
#if (MATERIAL_TEXTURES & 4) != 0
    vec3 n = material_texel(u_normal_texture, m.material, SLOT_NORMAL, m.uv0, m.uv1).xyz;
    n = (n * 255.0 - 128.0) / 127.0;  // code 128 is 0: a flat normal map stays flat
    n.xy *= materials[m.material].normal_scale;
    s.normal_ts = normalize(vec3(n.xy, max(n.z, 1e-3)));
#endif
#if (MATERIAL_TEXTURES & 8) != 0
    float ao = material_texel(u_occlusion_texture, m.material, SLOT_OCCLUSION, m.uv0, m.uv1).r;
    s.ambient_occlusion = 1.0 + materials[m.material].occlusion_strength * (ao - 1.0);
#endif
#if (MATERIAL_TEXTURES & 16) != 0
    s.emissive *= material_texel(u_emissive_texture, m.material, SLOT_EMISSIVE, m.uv0, m.uv1).rgb;
#endif
    float transmission = materials[m.material].transmission;
    vec3 entering = base_color.rgb * (1.0 - metallic);
    s.albedo = entering * (1.0 - transmission);
    s.transmission = entering * transmission;
    s.ior = materials[m.material].ior;
    s.thickness = materials[m.material].thickness;
    s.absorption = absorption_of(materials[m.material].attenuation_color,
                                 materials[m.material].attenuation_distance);
    s.opacity = base_color.a;
    s.specular_color = mix(vec3(reflectance_of_ior(s.ior)), base_color.rgb, metallic);
    return s;
}

// A magenta checker of so many squares a metre.
const float FALLBACK_SQUARES_A_M = 8.0;

Surface fallback_surface(vec3 position_ws) {
    vec3 cell = floor(position_ws * FALLBACK_SQUARES_A_M + 1e-3);
    float odd = mod(cell.x + cell.y + cell.z, 2.0);
    Surface s = plain_surface();
    make_unlit(s, vec3(1.0, 0.0, 1.0) * mix(0.05, 1.0, odd));
    return s;
}

#include <material>
#ifndef HAS_MATERIAL
struct Parameters { float none; };
Parameters material_parameters(uint material) { return Parameters(0.0); }
void material(inout Surface s, MaterialInput m, Parameters p) { s = standard_surface(m); }
vec3 displace(MaterialInput m, Parameters p) { return vec3(0.0); }
#endif

#if MATERIAL_FAULTS
bool is_faulty(Surface s) {
    float sum = dot(s.albedo + s.specular_color + s.emissive + s.subsurface_color, vec3(1.0));
    sum += dot(s.normal_ts + s.height_gradient + s.transmission + s.absorption, vec3(1.0));
    sum += s.opacity + s.roughness + s.ambient_occlusion + s.ior + s.thickness;
    return is_fault(sum + s.decal_mask);
}
#endif

// The surface with every value in its range. What is scattered below the surface and what is
// reflected diffusely share the light that enters: both together are at most 1.
Surface evaluate_material(MaterialInput m) {
    Surface s = plain_surface();
    material(s, m, material_parameters(m.material));
#if MATERIAL_FAULTS
    if (is_faulty(s)) {
        material_faults[m.material] = 1u;
        return fallback_surface(m.position_ws);
    }
#endif
#ifndef MATERIAL_IS_FALLBACK
    s.emissive = clamp(s.emissive, vec3(0.0), vec3(materials[m.material].emission_max));
#endif
    s.roughness = clamp(s.roughness, 0.0, 1.0);
    s.specular_power = specular_power_from_roughness(s.roughness);
    s.subsurface_color = clamp(s.subsurface_color, 0.0, 1.0);
    s.albedo = clamp(s.albedo, vec3(0.0), 1.0 - s.subsurface_color);
    return s;
}
