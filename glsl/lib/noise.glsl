// Noise for procedural materials: the same on every driver, since its random numbers are integers'.
// All functions return values about 0..1 unless they say otherwise; p in cells.

// Three random words of three. [Jarzynski20 "Hash Functions for GPU Rendering": pcg3d]
uvec3 hash_words(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// 0..1 by cell.
vec3 hash_cell(vec3 cell) {
    return vec3(hash_words(uvec3(ivec3(cell))) >> 8u) / 16777216.0;
}

// Gradient noise with its gradient: (d/dx, d/dy, d/dz, value), value about -1..1.
// [Quilez "Gradient noise derivatives"]
vec4 gradient_noise_d(vec3 p) {
    vec3 cell = floor(p);
    vec3 f = p - cell;
    vec3 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    vec3 du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    float value[8];
    vec3 slope[8];
    for (int k = 0; k < 8; ++k) {
        vec3 corner = vec3(k & 1, (k >> 1) & 1, k >> 2);
        slope[k] = hash_cell(cell + corner) * 2.0 - 1.0;
        value[k] = dot(slope[k], f - corner);
    }
    vec4 x00 = vec4(mix(slope[0], slope[1], u.x), mix(value[0], value[1], u.x));
    vec4 x10 = vec4(mix(slope[2], slope[3], u.x), mix(value[2], value[3], u.x));
    vec4 x01 = vec4(mix(slope[4], slope[5], u.x), mix(value[4], value[5], u.x));
    vec4 x11 = vec4(mix(slope[6], slope[7], u.x), mix(value[6], value[7], u.x));
    x00.x += du.x * (value[1] - value[0]);
    x10.x += du.x * (value[3] - value[2]);
    x01.x += du.x * (value[5] - value[4]);
    x11.x += du.x * (value[7] - value[6]);
    vec4 y0 = mix(x00, x10, u.y);
    vec4 y1 = mix(x01, x11, u.y);
    y0.y += du.y * (x10.w - x00.w);
    y1.y += du.y * (x11.w - x01.w);
    vec4 z = mix(y0, y1, u.z);
    z.z += du.z * (y1.w - y0.w);
    return z;
}

// Octaves of gradient noise, each half as large and twice as fine; gradient and value as above.
vec4 fractal_noise_d(vec3 p, int octaves) {
    vec4 sum = vec4(0.0);
    float amplitude = 1.0, frequency = 1.0, total = 0.0;
    for (int k = 0; k < octaves; ++k) {
        vec4 n = gradient_noise_d(p * frequency + float(k) * 17.0);
        sum += amplitude * vec4(n.xyz * frequency, n.w);
        total += amplitude;
        amplitude *= 0.5;
        frequency *= 2.0;
    }
    return sum / total;
}

float fractal_noise(vec3 p, int octaves) {
    return 0.5 + 0.5 * fractal_noise_d(p, octaves).w;
}

// Cracks of a mosaic: x: distance to the nearest border between two cells, y: a random number of
// the cell. [Quilez "Voronoi borders"], over the 27 cells around.
vec2 mosaic(vec3 p) {
    vec3 cell = floor(p);
    vec3 f = p - cell;
    vec3 nearest = vec3(8.0), nearest_cell = vec3(0.0);
    float least = 64.0;
    for (int k = 0; k < 27; ++k) {
        vec3 there = vec3(k % 3, (k / 3) % 3, k / 9) - 1.0;
        vec3 offset = there + hash_cell(cell + there) - f;
        float squared = dot(offset, offset);
        if (squared < least) {
            least = squared;
            nearest = offset;
            nearest_cell = cell + there;
        }
    }
    float border = 8.0;
    for (int k = 0; k < 27; ++k) {
        vec3 there = vec3(k % 3, (k / 3) % 3, k / 9) - 1.0;
        vec3 offset = there + hash_cell(cell + there) - f;
        vec3 between = offset - nearest;
        float squared = dot(between, between);
        if (squared > 1e-6)
            border = min(border, dot(0.5 * (nearest + offset), between) * inversesqrt(squared));
    }
    return vec2(border, hash_cell(nearest_cell + 71.0).x);
}
