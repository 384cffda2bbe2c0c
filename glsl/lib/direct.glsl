// Direct light on one visible surface point: the loop over the lights that shading in deferred and
// in forward passes share.
#include "lib/brdf.glsl"
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
};

struct DirectLight {
    vec3 diffuse;           // radiance
    vec3 specular;          // radiance
};

// Radiance towards the eye of one light, without its shadow.
DirectLight reflect_light(ShadingPoint p, Light light) {
    LightSample s = sample_light(light, p.p_ws);
    float n_o_l = clamp(dot(p.n_ws, s.to_light), 0.0, 1.0);
    // Beyond the light's reach, or from behind, where the half vector may be none.
    if (n_o_l <= 0.0 || s.irradiance == vec3(0.0)) return DirectLight(vec3(0.0), vec3(0.0));
    vec3 h = normalize(s.to_light + p.to_eye);
    float area_angle = light_area_angle(light.source_radius, s.distance_m);
    vec3 fresnel = fresnel_schlick(p.specular_color, dot(p.to_eye, h));
    DirectLight reflected;
    reflected.diffuse = s.irradiance * n_o_l * p.albedo / PI;
    reflected.specular = s.irradiance * fresnel
        * gaussian_specular(p.n_ws, h, n_o_l, p.specular_power, area_angle);
    return reflected;
}

DirectLight direct_light(ShadingPoint p) {
    DirectLight sum = DirectLight(vec3(0.0), vec3(0.0));
    for (LightWalk walk = first_light(p.p_ws); walk.light < light_count(); next_light(walk)) {
        DirectLight reflected = reflect_light(p, lights[walk.light]);
        vec3 both = reflected.diffuse + reflected.specular;
        if (max(both.r, max(both.g, both.b)) <= 0.0) continue;
        float visibility = light_visibility_in_view(walk.light, p.p_ws, p.n_ws);
        sum.diffuse += reflected.diffuse * visibility;
        sum.specular += reflected.specular * visibility;
    }
    return sum;
}
