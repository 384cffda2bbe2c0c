// Direct light on one visible surface point: the loop over the lights that shading in deferred and
// in forward passes share.
#include "lib/brdf.glsl"
#include "lib/lighting_models.glsl"
#include "lib/view.glsl"
#include "lib/light_cells.glsl"
#include "lib/lights.glsl"
#include "lib/shadow.glsl"

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
ShadingPoint shading_point(vec3 p_ws, vec3 n_ws, vec3 albedo, vec3 specular_color,
                           float specular_power, vec3 subsurface_color, uint lighting_model) {
    vec3 to_eye = normalize(u_view.eye_ws - p_ws);
    float n_o_v = clamp(dot(n_ws, to_eye), 0.0, 1.0);
    float roughness = roughness_from_specular_power(specular_power);
    vec3 mirrored = mirrored_share(lighting_model, specular_color, roughness, n_o_v);
    vec3 through = lighting_model == LIGHTING_SUBSURFACE ? subsurface_color : vec3(0.0);
    vec3 hold = diffuse_hold(albedo, through, mirrored);
    return ShadingPoint(p_ws, n_ws, to_eye, albedo * hold, specular_color, specular_power,
                        through * hold, lighting_model, mirrored);
}

// Radiance towards the eye of one light from the surface's own side, without its shadow.
DirectLight reflect_sample(ShadingPoint p, LightSample s, float source_radius) {
    float n_o_l = clamp(dot(p.n_ws, s.to_light), 0.0, 1.0);
    // Beyond the light's reach, or from behind, where the half vector may be none.
    if (n_o_l <= 0.0 || s.irradiance == vec3(0.0)) return DirectLight(vec3(0.0), vec3(0.0));
    vec3 h = normalize(s.to_light + p.to_eye);
    DirectLight reflected;
    reflected.diffuse = s.irradiance * n_o_l * p.albedo / PI;
    if (p.lighting_model == LIGHTING_CLOTH) {
        float roughness = roughness_from_specular_power(p.specular_power);
        float n_o_v = clamp(dot(p.n_ws, p.to_eye), 0.0, 1.0);
        float n_o_h = clamp(dot(p.n_ws, h), 0.0, 1.0);
        float held = 1.0 / max(cloth_albedo(roughness, n_o_v), 1.0);
        reflected.specular = s.irradiance * p.specular_color
            * (cloth_specular(n_o_h, n_o_l, n_o_v, roughness) * held);
        return reflected;
    }
    float area_angle = light_area_angle(source_radius, s.distance_m);
    vec3 fresnel = fresnel_schlick(p.specular_color, dot(p.to_eye, h));
    reflected.specular = s.irradiance * fresnel * GAUSSIAN_SPECULAR_BALANCE
        * gaussian_specular(p.n_ws, h, n_o_l, p.specular_power, area_angle);
    return reflected;
}

// Radiance towards the eye of one light that shines through the surface, without its shadow.
vec3 transmit_sample(ShadingPoint p, LightSample s) {
    float share = transmitted_share(dot(p.n_ws, s.to_light), -dot(s.to_light, p.to_eye));
    return s.irradiance * p.subsurface_color * (share / PI);
}

// Depths at which light that shines through is looked for, by the reach below the surface: the
// share that is lit falls as the body gets thicker. [inferred: after translucent shadow maps
// [Dachsbacher03], with the depth that is there instead of one that is stored]
const float TRANSMISSION_DEPTHS[3] = float[](0.15, 0.45, 1.0);

// Visibility 0..1 of a light through a body no thicker than u_view.subsurface_reach.
float transmitted_visibility(uint light, vec3 p_ws, vec3 to_light) {
    float lit = 0.0;
    for (int k = 0; k < 3; ++k) {
        vec3 below_ws = p_ws + to_light * (TRANSMISSION_DEPTHS[k] * u_view.subsurface_reach);
        lit += light_visibility_in_view(light, below_ws, to_light) / 3.0;
    }
    return lit;
}

float largest(vec3 v) { return max(v.r, max(v.g, v.b)); }

DirectLight direct_light(ShadingPoint p) {
    DirectLight sum = DirectLight(vec3(0.0), vec3(0.0));
    bool shines_through = largest(p.subsurface_color) > 0.0;
    for (LightWalk walk = first_light(p.p_ws); walk.light < light_count(); next_light(walk)) {
        Light light = lights[walk.light];
        LightSample s = sample_light(light, p.p_ws);
        DirectLight reflected = reflect_sample(p, s, light.source_radius);
        if (largest(reflected.diffuse + reflected.specular) > 0.0) {
            float visibility = light_visibility_in_view(walk.light, p.p_ws, p.n_ws);
            sum.diffuse += reflected.diffuse * visibility;
            sum.specular += reflected.specular * visibility;
        }
        if (!shines_through) continue;
        vec3 through = transmit_sample(p, s);
        if (largest(through) <= 0.0) continue;
        sum.diffuse += through * transmitted_visibility(walk.light, p.p_ws, s.to_light);
    }
    return sum;
}
