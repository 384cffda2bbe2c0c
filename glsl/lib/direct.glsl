// Direct light on one visible surface point: the loop over the lights that shading in deferred and
// in forward passes share.
#include "lib/brdf.glsl"
#include "lib/lighting_models.glsl"
#include "lib/view.glsl"
#include "lib/light_cells.glsl"
#include "lib/lights.glsl"
#include "lib/shadow.glsl"

// The point that a surface shows towards the eye.
ShadingPoint seen_point(vec3 p_ws, vec3 n_ws, vec3 albedo, vec3 specular_color,
                        float specular_power, vec3 subsurface_color, uint lighting_model) {
    return shading_point(p_ws, n_ws, normalize(u_view.eye_ws - p_ws), albedo, specular_color,
                         specular_power, subsurface_color, lighting_model);
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

// How wide a pixel is where it shows a point, m.
float pixel_width_m(vec3 p_ws) {
    return 2.0 * view_ray().y * u_view.viewport_px.w * distance(u_view.eye_ws, p_ws);
}

float largest(vec3 v) { return max(v.r, max(v.g, v.b)); }

DirectLight direct_light(ShadingPoint p) {
    DirectLight sum = DirectLight(vec3(0.0), vec3(0.0));
    float footprint_m = pixel_width_m(p.p_ws);
    bool shines_through = SUBSURFACE_IS_USED && largest(p.subsurface_color) > 0.0;
    for (LightWalk walk = first_light(p.p_ws); walk.light < light_count(); next_light(walk)) {
        Light light = lights[walk.light];
        LightSample s = sample_light(light, p.p_ws, footprint_m);
        DirectLight reflected = reflect_sample(p, s.to_light, s.irradiance,
            light_area_angle(light.source_radius, s.distance_m));
        if (largest(reflected.diffuse + reflected.specular) > 0.0) {
            float visibility = light_visibility_in_view(walk.light, p.p_ws, p.n_ws);
            sum.diffuse += reflected.diffuse * visibility;
            sum.specular += reflected.specular * visibility;
        }
        if (!shines_through) continue;
        vec3 through = transmit_sample(p, s.to_light, s.irradiance);
        if (largest(through) <= 0.0) continue;
        sum.diffuse += through * transmitted_visibility(walk.light, p.p_ws, s.to_light);
    }
    return sum;
}
