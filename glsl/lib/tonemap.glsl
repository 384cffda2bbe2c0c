// From display-referred linear colour to display codes.

// IEC 61966-2-1, per channel.
vec3 srgb_encode(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c,
               lessThanEqual(c, vec3(0.0031308)));
}

uint hash_pcg(uint x) {  // [Jarzynski20 "Hash Functions for GPU Rendering"]
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Triangular noise in -1..1, the same for a pixel every time: added before rounding to 8 bits it
// makes the error independent of the signal [Roberts62], so gradients do not band.
vec3 dither_triangular(uvec2 pixel) {
    vec3 noise;
    uint state = hash_pcg(pixel.x + hash_pcg(pixel.y));
    for (int i = 0; i < 3; ++i) {
        state = hash_pcg(state);
        noise[i] = (float(state & 0xffffu) + float(state >> 16u)) / 65535.0 - 1.0;
    }
    return noise;
}
