// Scales one level so that its mean over the sphere is the image's own, channel by channel: a small
// bright sun would else gain or lose by where the samples fall. One work group.
layout(local_size_x = 256) in;

#include "lib/packing.glsl"

#include "shared/sky_normalize.glsl"

layout(rgba32f) uniform image2D u_level;

const uint TENT_SAMPLES = 4u;  // a side of a texel's tent, which is two texels wide

// Solid angle that bilinear filtering gives to a texel: the sphere's area under its tent.
float texel_weight(vec2 center, float texel) {
    float sum = 0.0;
    for (uint i = 0u; i < TENT_SAMPLES * TENT_SAMPLES; ++i) {
        vec2 cell = vec2(i % TENT_SAMPLES, i / TENT_SAMPLES);
        vec2 offset = (cell + 0.5) / float(TENT_SAMPLES) * 2.0 - 1.0;
        vec2 tent = 1.0 - abs(offset);
        sum += tent.x * tent.y * octahedral_weight(octahedral_fold(center + offset * texel));
    }
    return sum;
}

shared vec4 sums[256];  // weighted radiance, weight

void main() {
    uint thread = gl_LocalInvocationID.x;
    uint content = u_pass.size - 2u;
    vec4 sum = vec4(0.0);
    for (uint i = thread; i < content * content; i += 256u) {
        uvec2 texel = uvec2(i % content, i / content);
        vec2 center = (vec2(texel) + 0.5) / float(content) * 2.0 - 1.0;
        float weight = texel_weight(center, 2.0 / float(content));
        sum += vec4(imageLoad(u_level, ivec2(texel) + 1).rgb, 1.0) * weight;
    }
    sums[thread] = sum;
    barrier();
    for (uint width = 128u; width > 0u; width >>= 1u) {
        if (thread < width) sums[thread] += sums[thread + width];
        barrier();
    }
    vec3 level_mean = sums[0].rgb / sums[0].a;
    vec3 gain = mix(u_pass.mean / max(level_mean, vec3(1e-30)), vec3(1.0),
                    equal(level_mean, vec3(0.0)));
    for (uint i = thread; i < u_pass.size * u_pass.size; i += 256u) {
        ivec2 texel = ivec2(i % u_pass.size, i / u_pass.size);
        imageStore(u_level, texel, vec4(imageLoad(u_level, texel).rgb * gain, 1.0));
    }
}
