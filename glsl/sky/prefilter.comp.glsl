// One level of the cone pyramid from the finer one. A uniform cone's mean squared angle is a^2 / 2
// and successive blurs add theirs, so a cone twice as wide as the source's is the source under a
// cone of sqrt(4 - 1) / 2 of the new half angle. [inferred]
layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/brdf.glsl"
#include "lib/packing.glsl"

#include "shared/sky_prefilter.glsl"

uniform sampler2D u_source;
layout(rgba32f) writeonly uniform image2D o_level;

const uint CONE_SAMPLES = 96u;
const float GOLDEN_ANGLE = 2.39996323;  // radians; a sunflower's spiral covers the cap evenly

vec3 source_radiance(vec3 direction) {
    float size = float(u_pass.source_size);
    vec2 uv = ((octahedral_encode(direction) * 0.5 + 0.5) * (size - 2.0) + 1.0) / size;
    return textureLod(u_source, uv, 0.0).rgb;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(u_pass.size)))) return;
    float content = float(u_pass.size) - 2.0;
    vec2 p = octahedral_fold((vec2(texel) - 0.5) / content * 2.0 - 1.0);
    vec3 axis = octahedral_decode(p);
    vec3 side = normalize(abs(axis.y) < 0.9 ? cross(axis, vec3(0.0, 1.0, 0.0))
                          : cross(axis, vec3(1.0, 0.0, 0.0)));
    vec3 up = cross(side, axis);
    float cap = 1.0 - cos(u_pass.half_angle);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < CONE_SAMPLES; ++i) {
        float cosine = 1.0 - cap * (float(i) + 0.5) / float(CONE_SAMPLES);
        float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
        float turn = float(i) * GOLDEN_ANGLE;
        sum += source_radiance(axis * cosine + (side * cos(turn) + up * sin(turn)) * sine);
    }
    imageStore(o_level, texel, vec4(sum / float(CONE_SAMPLES), 1.0));
}
