// All lines of histograms into one, the average between two percentiles, and the eye's next step
// towards it. [Mittring12 "Histogram", "Eye Adaptation (Auto-Exposure)"]
layout(local_size_x = 16, local_size_y = 16) in;

#include "shared/exposure.glsl"

layout(std430) buffer EyeState { Eye eye; };
uniform sampler2D u_lines;

shared vec4 sums[gl_WorkGroupSize.y][HISTOGRAM_TEXELS];

float bucket_brightness(uint bucket) {
    float place = float(bucket) / float(HISTOGRAM_BUCKETS - 1u);
    return exp2(u_exposure.log_min + place * u_exposure.log_range);
}

// Average brightness of what lies between the shares low and high of the picture.
float average_between(float low, float high) {
    float brightness = 0.0;
    float weight = 0.0;
    for (uint bucket = 0u; bucket < HISTOGRAM_BUCKETS; ++bucket) {
        float share = sums[0][bucket / 4u][bucket % 4u];
        float darker = min(share, low);
        low -= darker;
        float used = min(share - darker, high - darker);
        high -= darker + used;
        brightness += used * bucket_brightness(bucket);
        weight += used;
    }
    return brightness / weight;
}

void main() {
    uint texel = gl_LocalInvocationID.x;
    uint row = gl_LocalInvocationID.y;
    vec4 sum = vec4(0.0);
    for (int line = int(row); line < textureSize(u_lines, 0).y; line += int(gl_WorkGroupSize.y)) {
        sum += texelFetch(u_lines, ivec2(texel, line), 0);
    }
    sums[row][texel] = sum;
    barrier();
    if (row == 0u) {
        for (uint k = 1u; k < gl_WorkGroupSize.y; ++k) sum += sums[k][texel];
        sums[0][texel] = sum;
    }
    barrier();
    float total = 0.0;
    for (uint k = 0u; k < HISTOGRAM_TEXELS; ++k) total += dot(sums[0][k], vec4(1.0));
    barrier();
    if (row == 0u) {
        sums[0][texel] = sum / total;
        eye.histogram[texel] = sum / total;
    }
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    float measured = average_between(u_exposure.low_share, u_exposure.high_share);
    float lowest = u_exposure.min_brightness;
    float highest = u_exposure.max_brightness;
    // Also where it is no number.
    float wanted = measured > lowest ? min(measured, highest) : lowest;
    float before = u_exposure.starts == 1u ? wanted : clamp(eye.brightness, lowest, highest);
    float keep = wanted > before ? u_exposure.keep_up : u_exposure.keep_down;
    eye.measured = measured;
    eye.brightness = wanted + (before - wanted) * keep;
}
