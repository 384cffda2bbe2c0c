// How a surface of each lighting model reflects and lets through one light: the slides' formulas,
// light through a surface, cloth, and the share of light that is left for diffuse reflection. Pure
// functions; every direction is unit. [Mittring12 "Shading"]
//
// LIGHTING_MODELS is the mask of the models (1 << LIGHTING_*) that there may be; the code of the
// others is left out.
#include "shared/gbuffer.glsl"
#include "lib/brdf.glsl"

#ifndef LIGHTING_MODELS
#define LIGHTING_MODELS 15
#endif
#define SUBSURFACE_IS_USED ((LIGHTING_MODELS & 4) != 0)
#define CLOTH_IS_USED ((LIGHTING_MODELS & 8) != 0)

// The slide's energy term makes a sharp lobe reflect 2 pi^1.5 / 10 = 1.114 of the light
// [Mittring12 "Energy conserving"]: the integral of exp(-(h / a)^4) 4 h 2 pi over the half vector's
// angle h, over the slide's 10 a^2. A white furnace asks for its inverse.
const float GAUSSIAN_SPECULAR_BALANCE = 0.8979;

// How far light wraps around the terminator of what it shines through: 0 not at all, 1 to the far
// pole. [inferred: ears and fruit show about half]
const float TRANSMISSION_WRAP = 0.5;
// Exponent of the lobe around the light's own way, and its share of what shines through: the rest
// leaves in all directions. [inferred: leaves scatter forwards by about this much]
const float TRANSMISSION_POWER = 12.0;
const float TRANSMISSION_FORWARD = 0.35;

// Light that enters on the side away from the eye and leaves towards it: radiance is the subsurface
// colour * irradiance / pi * this. Over all directions of light it integrates to pi at most, so the
// subsurface colour is an albedo. Wrapped Lambert as in [McAuley13 "Energy-Conserving Wrapped
// Diffuse"], a normalized Phong lobe around the straight way through.
float transmitted_share(float n_o_l, float cosine_through) {
    float wide = 1.0 + TRANSMISSION_WRAP;
    float wrapped = clamp((TRANSMISSION_WRAP - n_o_l) / (wide * wide), 0.0, 1.0);
    float forward = 0.5 * (TRANSMISSION_POWER + 1.0)
        * pow(max(cosine_through, 0.0), TRANSMISSION_POWER);
    return mix(wrapped, forward, TRANSMISSION_FORWARD);
}

// Fibres that stand off a cloth: distribution of their normals [Estevez17 "Production Friendly
// Microfacet Sheen BRDF"] and visibility [Neubelt13 "Crafting a Next-Gen Material Pipeline"], times
// the cosine. Multiply with the sheen colour and the irradiance at normal incidence.
float cloth_specular(float n_o_h, float n_o_l, float n_o_v, float roughness) {
    float power = 1.0 / max(roughness * roughness, 1e-3);
    float sine_squared = max(1.0 - n_o_h * n_o_h, 1e-6);
    float distribution = (2.0 + power) * pow(sine_squared, 0.5 * power) * (0.5 * INVERSE_PI);
    float visibility = 0.25 / max(n_o_l + n_o_v - n_o_l * n_o_v, 1e-4);
    return distribution * visibility * n_o_l;
}

// Integral of cloth_specular over all lights: an exponential fitted by least squares to 15x20
// roughnesses from 0.3 and sqrt(n_o_v) from 0.12; mean error 0.0035, largest 0.013.
float cloth_albedo(float roughness, float n_o_v) {
    float r = roughness;
    float s = sqrt(n_o_v);
    return exp(1.873 + r * (-6.816 + r * (7.961 - 3.469 * r))
        + s * (-3.841 + r * (11.349 + r * (-18.326 + 10.166 * r))
        + s * (-2.529 + r * (10.879 - 8.572 * r) + s * (-4.280 + 3.689 * r))));
}

// Share of a uniform environment that a lighting model mirrors into the direction of cosine n_o_v.
// Below a roughness of 0.5 cloth of the model above would return more than arrives at grazing
// angles; it is held at 1.
vec3 mirrored_share(uint lighting_model, vec3 specular_color, float roughness, float n_o_v) {
    if (CLOTH_IS_USED && lighting_model == LIGHTING_CLOTH) {
        return specular_color * min(cloth_albedo(roughness, n_o_v), 1.0);
    }
    return environment_brdf(specular_color, roughness, n_o_v);
}

// By how much diffuse reflection and what shines through are held back, so that with what is
// mirrored no more leaves than arrived: 1 but for bright surfaces.
vec3 diffuse_hold(vec3 albedo, vec3 subsurface_color, vec3 mirrored) {
    vec3 left = max(1.0 - mirrored, 0.0);
    return min(left / max(albedo + subsurface_color, 1e-4), 1.0);
}

struct ShadingPoint {
    vec3 p_ws;
    vec3 n_ws;
    vec3 to_eye;            // unit
    vec3 albedo;
    vec3 specular_color;
    float specular_power;
    vec3 subsurface_color;
    uint lighting_model;    // LIGHTING_*
    vec3 mirrored;          // mirrored_share; what it leaves is the others'
};

struct DirectLight {
    vec3 diffuse;           // radiance
    vec3 specular;          // radiance
};

// A point to shade: albedo and subsurface colour are held back by what it mirrors.
ShadingPoint shading_point(vec3 p_ws, vec3 n_ws, vec3 to_eye, vec3 albedo, vec3 specular_color,
                           float specular_power, vec3 subsurface_color, uint lighting_model) {
    float n_o_v = clamp(dot(n_ws, to_eye), 0.0, 1.0);
    float roughness = roughness_from_specular_power(specular_power);
    vec3 mirrored = mirrored_share(lighting_model, specular_color, roughness, n_o_v);
    bool shines_through = SUBSURFACE_IS_USED && lighting_model == LIGHTING_SUBSURFACE;
    vec3 through = shines_through ? subsurface_color : vec3(0.0);
    vec3 hold = diffuse_hold(albedo, through, mirrored);
    return ShadingPoint(p_ws, n_ws, to_eye, albedo * hold, specular_color, specular_power,
                        through * hold, lighting_model, mirrored);
}

// Radiance towards the eye of one light from the surface's own side, without its shadow.
DirectLight reflect_sample(ShadingPoint p, vec3 to_light, vec3 irradiance, float area_angle) {
    float n_o_l = clamp(dot(p.n_ws, to_light), 0.0, 1.0);
    // Beyond the light's reach, or from behind, where the half vector may be none.
    if (n_o_l <= 0.0 || irradiance == vec3(0.0)) return DirectLight(vec3(0.0), vec3(0.0));
    vec3 between = to_light + p.to_eye;  // 0 where a bump faces a light straight behind it
    vec3 h = between * inversesqrt(max(dot(between, between), 1e-12));
    DirectLight reflected;
    reflected.diffuse = irradiance * n_o_l * p.albedo / PI;
    if (CLOTH_IS_USED && p.lighting_model == LIGHTING_CLOTH) {
        float roughness = roughness_from_specular_power(p.specular_power);
        float n_o_v = clamp(dot(p.n_ws, p.to_eye), 0.0, 1.0);
        float n_o_h = clamp(dot(p.n_ws, h), 0.0, 1.0);
        float held = 1.0 / max(cloth_albedo(roughness, n_o_v), 1.0);
        reflected.specular = irradiance * p.specular_color
            * (cloth_specular(n_o_h, n_o_l, n_o_v, roughness) * held);
        return reflected;
    }
    vec3 fresnel = fresnel_schlick(p.specular_color, dot(p.to_eye, h));
    reflected.specular = irradiance * fresnel * GAUSSIAN_SPECULAR_BALANCE
        * gaussian_specular(p.n_ws, h, n_o_l, p.specular_power, area_angle);
    return reflected;
}

// Radiance towards the eye of one light that shines through the surface, without its shadow.
vec3 transmit_sample(ShadingPoint p, vec3 to_light, vec3 irradiance) {
    float share = transmitted_share(dot(p.n_ws, to_light), -dot(to_light, p.to_eye));
    return irradiance * p.subsurface_color * (share / PI);
}
