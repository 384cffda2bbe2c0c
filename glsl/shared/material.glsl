// A material: glTF's metallic-roughness values, and those of the artist's own parameters. What they
// mean is derived in lib/material.glsl and in the material's snippet.
const uint MATERIAL_DOUBLE_SIDED = 2u;
const uint MATERIAL_MASK = 4u;
const uint MATERIAL_BLEND = 8u;

// Texture slots: bit in texture_mask and uv_set_mask, index in uv_row_u and uv_row_v.
const uint SLOT_BASE_COLOR = 0u;
const uint SLOT_METALLIC_ROUGHNESS = 1u;
const uint SLOT_NORMAL = 2u;
const uint SLOT_OCCLUSION = 3u;
const uint SLOT_EMISSIVE = 4u;
const uint SLOT_COUNT = 5u;

const uint MATERIAL_VECTORS = 8u;  // vec4s of the artist's own parameters

struct Material {
    vec4 base_color;    // linear
    vec3 emissive;      // radiance
    float metallic;
    float roughness;    // perceptual, alpha = roughness^2
    float normal_scale;
    float occlusion_strength;
    float alpha_cutoff;
    uint flags;         // MATERIAL_*
    uint texture_mask;  // bit SLOT_*: the slot has a texture
    uint uv_set_mask;   // bit SLOT_*: the slot reads the second uv set
    float emission_max; // radiance beyond is cut: voxels have a range
    vec3 attenuation_color;      // of the light that passes attenuation_distance of the body
    float attenuation_distance;  // m; 0: nothing is absorbed
    float transmission; // share of the light that enters and passes through
    float ior;          // index of refraction
    float thickness;    // of the body behind the surface, in local units; 0: a thin wall
    float reserved0;
    vec4 uv_row_u[5];   // per slot: u = dot(row.xyz, vec3(uv, 1)), KHR_texture_transform
    vec4 uv_row_v[5];
    vec4 parameters[8]; // where each is, the material's definition says
};

layout(std430) readonly buffer Materials { Material materials[]; };

// What all materials of a frame are evaluated with.
layout(std140) uniform MaterialFrame {
    float time_s;
} u_material;
