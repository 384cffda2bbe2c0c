// Radiance of the environment, averaged over a cone.
#include "shared/sky.glsl"
#include "lib/packing.glsl"

// Octahedral map. Level l holds the radiance averaged over cones of the half angle
// widest_angle / 2^(level_count - 1 - l). Each level has a border of one texel that repeats its
// neighbours across the map's edge, so bilinear filtering is seamless.
uniform sampler2D u_sky;

vec3 sky_level(vec2 octahedral, float level) {
    float size = u_sky_params.size * exp2(-level);
    vec2 uv = ((octahedral * 0.5 + 0.5) * (size - 2.0) + 1.0) / size;
    return textureLod(u_sky, uv, level).rgb;
}

// Radiance from dir (unit, world space), averaged over a cone of that half angle in radians.
vec3 sky_radiance(vec3 dir, float cone_half_angle) {
    vec2 octahedral = octahedral_encode(dir);
    float last = u_sky_params.level_count - 1.0;
    float level = clamp(last + log2(max(cone_half_angle, 1e-6) / u_sky_params.widest_angle), 0.0,
                        last);
    float lower = floor(level);
    vec3 fine = sky_level(octahedral, lower);
    vec3 coarse = sky_level(octahedral, min(lower + 1.0, last));
    return mix(fine, coarse, level - lower) * u_sky_params.tint;
}
