// Equirectangular image to level 0 of the octahedral map, each texel the mean over its solid angle.
layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/brdf.glsl"
#include "lib/packing.glsl"

#include "shared/sky_project.glsl"

// Row 0 is +y, the middle column -z.
uniform sampler2D u_equirect;
layout(rgba32f) writeonly uniform image2D o_level;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(u_pass.size)))) return;
    float content = float(u_pass.size) - 2.0;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (uint i = 0u; i < u_pass.samples * u_pass.samples; ++i) {
        vec2 cell = (vec2(i % u_pass.samples, i / u_pass.samples) + 0.5) / float(u_pass.samples);
        vec2 p = octahedral_fold((vec2(texel) - 1.0 + cell) / content * 2.0 - 1.0);
        vec3 d = octahedral_decode(p);
        vec2 uv = vec2(0.5 + atan(d.x, -d.z) / (2.0 * PI), acos(clamp(d.y, -1.0, 1.0)) / PI);
        float weight = octahedral_weight(p);
        sum += textureLod(u_equirect, uv, 0.0).rgb * weight;
        weights += weight;
    }
    imageStore(o_level, texel, vec4(sum / weights, 1.0));
}
