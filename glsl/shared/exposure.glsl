// How bright the picture is developed. [Mittring12 "Eye Adaptation (Auto-Exposure)"]
const uint HISTOGRAM_BUCKETS = 64u;
const uint HISTOGRAM_TEXELS = 16u;   // a line of four buckets each
const uint HISTOGRAM_TILE = 32u;     // px a side of what one work group counts [inferred]

layout(std140) uniform Exposure {
    float bias;              // factor on the picture, 2^EV
    float log_min;           // EV of the first bucket
    float log_range;         // EV from the first bucket to the last
    float low_share;         // 0..1: darker ones are left out of the average
    float high_share;        // 0..1: brighter ones are left out
    float min_brightness;    // bounds of what the eye adapts to
    float max_brightness;
    float keep_up;           // share of the distance left after this frame, towards the bright
    float keep_down;         // towards the dark
    uint starts;             // 1: no frame before this one, adapted at once
} u_exposure;

// What the eye knows from frame to frame; all of it stays on the GPU.
struct Eye {
    vec4 histogram[HISTOGRAM_TEXELS];  // shares of the picture, they add up to 1
    float brightness;                  // adapted to: is shown as 1
    float measured;                    // average between the percentiles, unbounded
    float reserved0;
    float reserved1;
};
