// Histograms of the picture's tiles, without atomics: each thread counts into a column of its own.
// [Mittring12 "Histogram"]; a texel is split between the two nearest buckets, so that the count
// moves continuously with the picture [inferred: the slide's histograms are of floats].
layout(local_size_x = 4, local_size_y = 4) in;

#include "shared/exposure.glsl"
#include "lib/color.glsl"

uniform sampler2D u_picture;
layout(rgba32f) writeonly uniform image2D o_lines;

const uint COLUMNS = 16u;     // threads of a group
const float BLACK = 1e-20;    // log2 stays finite

shared float histograms[HISTOGRAM_BUCKETS][COLUMNS];

float bucket_position(vec3 radiance) {
    float brightness = luminance(radiance);
    // What is no number counts as black.
    float ev = brightness > BLACK ? log2(brightness) : log2(BLACK);
    float scaled = (ev - u_exposure.log_min) / u_exposure.log_range;
    return clamp(scaled, 0.0, 1.0) * float(HISTOGRAM_BUCKETS - 1u);
}

void main() {
    uint column = gl_LocalInvocationIndex;
    for (uint bucket = 0u; bucket < HISTOGRAM_BUCKETS; ++bucket) histograms[bucket][column] = 0.0;
    barrier();
    ivec2 size = textureSize(u_picture, 0);
    uvec2 tile = gl_WorkGroupID.xy * HISTOGRAM_TILE + gl_LocalInvocationID.xy;
    for (uint y = 0u; y < HISTOGRAM_TILE; y += gl_WorkGroupSize.y) {
        for (uint x = 0u; x < HISTOGRAM_TILE; x += gl_WorkGroupSize.x) {
            ivec2 pixel = ivec2(tile + uvec2(x, y));
            if (any(greaterThanEqual(pixel, size))) continue;
            float position = bucket_position(texelFetch(u_picture, pixel, 0).rgb);
            uint lower = min(uint(position), HISTOGRAM_BUCKETS - 2u);
            float upper_share = position - float(lower);
            histograms[lower][column] += 1.0 - upper_share;
            histograms[lower + 1u][column] += upper_share;
        }
    }
    barrier();
    vec4 sums = vec4(0.0);
    for (uint bucket = 0u; bucket < 4u; ++bucket) {
        for (uint k = 0u; k < COLUMNS; ++k) sums[bucket] += histograms[column * 4u + bucket][k];
    }
    uint line = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    imageStore(o_lines, ivec2(column, line), sums);
}
