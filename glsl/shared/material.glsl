// Metallic-roughness materials as glTF states them; the talk's model is derived in lib/material.glsl.
const uint MATERIAL_UNLIT = 1u;
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
    uint reserved;
    vec4 uv_row_u[5];   // per slot: u = dot(row.xyz, vec3(uv, 1)), KHR_texture_transform
    vec4 uv_row_v[5];
};

layout(std430) readonly buffer Materials { Material materials[]; };
