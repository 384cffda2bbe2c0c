layout(std140) uniform BloomThreshold {
    float threshold;  // exposed luminance
} u_bloom;
