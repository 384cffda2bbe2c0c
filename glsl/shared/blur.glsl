const uint BLUR_PAIRS = 32u;  // of texels on either side: a kernel of 128 texels

// A Gaussian along one axis; each pair of texels is one lookup between them.
layout(std140) uniform Blur {
    vec4 pairs[BLUR_PAIRS];  // x: texels from the centre, y: weight on either side
    vec3 factor;             // on the whole kernel
    float center;            // weight of the centre
    vec2 axis;
    uint count;              // pairs in use
    uint reserved0;
} u_blur;
