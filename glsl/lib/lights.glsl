// Punctual lights by the text of KHR_lights_punctual, and their photometric profiles.
#include "lib/math.glsl"
#include "shared/light.glsl"

// Profiles: intensity over the peak; columns go round the axis, rows from the way the light points
// to its back. Masks: the share of each primary, as pictures, the first row on top. All repeat.
uniform sampler2DArray u_light_shapes;

struct LightSample {
    vec3 to_light;     // unit
    float distance_m;  // 1 for a directional light: its source_radius is an angle already
    vec3 irradiance;   // on a surface that faces the light, without shadow
};

const float LIGHT_DISTANCE_MIN = 1e-3;  // m: keeps the inverse square finite

// 1 near the light, 0 at the range and beyond: max(min(1 - (d / range)^4, 1), 0).
// The 1 / d^2 of the extension's formula is applied by the caller.
float range_window(float distance_m, float range) {
    if (range <= 0.0) return 1.0;
    float ratio = distance_m / range;
    float squared = ratio * ratio;
    return clamp(1.0 - squared * squared, 0.0, 1.0);
}

// 1 inside the inner cone, 0 outside the outer: the extension's recommended angular attenuation.
float spot_falloff(Light light, vec3 to_light) {
    float cosine = dot(light.direction_ws, -to_light);
    float attenuation = clamp(cosine * light.spot_scale + light.spot_offset, 0.0, 1.0);
    return attenuation * attenuation;
}

// Share of the peak intensity that a luminaire sends towards a point. [LM-63-2002], type C
float profile_falloff(Light light, vec3 to_light) {
    vec3 across = cross(light.direction_ws, light.profile_axis_ws);
    vec2 around = vec2(dot(-to_light, light.profile_axis_ws), dot(-to_light, across));
    float turned = dot(around, around) > 1e-12 ? atan(around.y, around.x) * (0.5 / PI) : 0.0;
    float down = acos(clamp(dot(-to_light, light.direction_ws), -1.0, 1.0)) / PI;
    float pole = 0.5 / float(textureSize(u_light_shapes, 0).y);
    down = clamp(down, pole, 1.0 - pole);
    return textureLod(u_light_shapes, vec3(turned, down, float(light.profile)), 0.0).r;
}

// What a light's mask lets through to a point, which lies `offset` from the light: the mean over
// a place that is `footprint_m` wide.
vec3 mask_share(Light light, vec3 offset, float footprint_m) {
    vec3 down = cross(light.direction_ws, light.profile_axis_ws);
    vec2 across = vec2(dot(offset, light.profile_axis_ws), dot(offset, down)) * light.mask_scale;
    float texels = float(textureSize(u_light_shapes, 0).x);
    if (light.kind == LIGHT_DIRECTIONAL) {
        float lod = log2(max(footprint_m * light.mask_scale * texels, 1.0));
        vec2 uv = across + 0.5 - light.mask_offset;
        return textureLod(u_light_shapes, vec3(uv, float(light.mask)), lod).rgb;
    }
    float along = dot(offset, light.direction_ws);
    if (along <= 0.0) return vec3(0.0);
    float lod = log2(max(0.5 * footprint_m * light.mask_scale / along * texels, 1.0));
    vec2 uv = across * (0.5 / along) + 0.5;
    if (any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return vec3(0.0);
    // What repeats is not seen.
    float rim = light.mask_offset == vec2(0.0) ? 0.5 * exp2(lod) / texels : 0.0;
    uv = clamp(uv, min(rim, 0.5), 1.0 - min(rim, 0.5)) - light.mask_offset;
    return textureLod(u_light_shapes, vec3(uv, float(light.mask)), lod).rgb;
}

// What a light sends to a place that is `footprint_m` wide.
LightSample sample_light(Light light, vec3 p_ws, float footprint_m) {
    LightSample s;
    if (light.kind == LIGHT_DIRECTIONAL) {
        s.to_light = -light.direction_ws;
        s.distance_m = 1.0;
        s.irradiance = light.intensity;
        if (light.mask >= 0)
            s.irradiance *= mask_share(light, p_ws - light.position_ws, footprint_m);
        return s;
    }
    vec3 offset = light.position_ws - p_ws;
    s.distance_m = max(length(offset), LIGHT_DISTANCE_MIN);
    s.to_light = offset / s.distance_m;
    float falloff = range_window(s.distance_m, light.range) / (s.distance_m * s.distance_m);
    if (light.kind == LIGHT_SPOT) falloff *= spot_falloff(light, s.to_light);
    if (light.profile >= 0) falloff *= profile_falloff(light, s.to_light);
    s.irradiance = light.intensity * falloff;
    if (light.mask >= 0) s.irradiance *= mask_share(light, -offset, footprint_m);
    return s;
}
