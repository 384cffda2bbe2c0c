// What a material is given of a point, and what it says about it: the artist's side of
// lib/material.glsl. docs/materials.md explains both.
#include "shared/gbuffer.glsl"
#include "lib/brdf.glsl"

struct MaterialInput {
    uint material;      // index into materials[]
    vec3 position_ws;   // m
    vec3 normal_ws;     // unit, of the mesh, on the side that is seen
    vec2 uv0;
    vec2 uv1;
    vec4 color;         // of the vertex, linear
    float time_s;       // of the scene
};

struct Surface {
    vec3 albedo;            // diffuse
    float opacity;
    vec3 specular_color;    // reflectance at normal incidence; of cloth its sheen
    float roughness;        // perceptual, alpha = roughness^2
    float specular_power;   // follows from the roughness once the material is through
    vec3 emissive;          // radiance, nit
    float ambient_occlusion;
    vec3 normal_ts;         // unit, tangent space: what a normal map says
    vec3 height_gradient;   // world space: how a height over the surface changes, m a m
    vec3 subsurface_color;  // share of the light that leaves elsewhere: back-lit, around the edge
    vec3 transmission;      // share of the light that passes through a translucent surface
    vec3 absorption;        // of the body behind it, 1 / m
    float thickness;        // of that body, in the mesh's own units; 0: a thin wall
    float ior;              // index of refraction
    float decal_mask;       // share of a decal that the surface takes on
    uint lighting_model;    // LIGHTING_*
};

// Reflectance of a dielectric at normal incidence, glTF 2.0 appendix B (index of refraction 1.5).
const vec3 DIELECTRIC_SPECULAR = vec3(0.04);

// Where a material begins: a white, rough dielectric.
Surface plain_surface() {
    Surface s;
    s.albedo = vec3(1.0);
    s.opacity = 1.0;
    s.specular_color = DIELECTRIC_SPECULAR;
    s.roughness = 1.0;
    s.specular_power = SPECULAR_POWER_MIN;
    s.emissive = vec3(0.0);
    s.ambient_occlusion = 1.0;
    s.normal_ts = vec3(0.0, 0.0, 1.0);
    s.height_gradient = vec3(0.0);
    s.subsurface_color = vec3(0.0);
    s.transmission = vec3(0.0);
    s.absorption = vec3(0.0);
    s.thickness = 0.0;
    s.ior = 1.5;
    s.decal_mask = 1.0;
    s.lighting_model = LIGHTING_DEFAULT;
    return s;
}

// Makes a surface show one radiance, whatever the light.
void make_unlit(inout Surface s, vec3 radiance) {
    s.emissive = radiance;
    s.albedo = vec3(0.0);
    s.specular_color = vec3(0.0);
    s.subsurface_color = vec3(0.0);
    s.lighting_model = LIGHTING_UNLIT;
}
