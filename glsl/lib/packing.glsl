// Small encodings. Each has its inverse; none binds anything.

const float HALF_MAX = 65504.0;  // the largest finite half float

// Shared-exponent colour: 9 bits a channel, 5 bits of exponent, as OpenGL's RGB9_E5
// (OpenGL 4.3 core, section 8.5.2 "Encoding of Special Internal Formats").
const float RGB9E5_MAX = 65408.0;  // (2^9 - 1) / 2^9 * 2^(31 - 15)
const int RGB9E5_BIAS = 15;
const int RGB9E5_MANTISSA_BITS = 9;

uint rgb9e5_pack(vec3 color) {
    vec3 c = clamp(color, vec3(0.0), vec3(RGB9E5_MAX));
    float largest = max(max(c.r, c.g), max(c.b, uintBitsToFloat(1u << 23)));
    // floor(log2(x)) from the exponent bits: exact, where log2() may round up.
    int exponent = int(floatBitsToUint(largest) >> 23) - 127;
    int shared_exponent = max(-RGB9E5_BIAS - 1, exponent) + 1 + RGB9E5_BIAS;
    float scale = exp2(float(RGB9E5_MANTISSA_BITS + RGB9E5_BIAS - shared_exponent));
    if (floor(largest * scale + 0.5) >= 512.0) {
        shared_exponent += 1;
        scale *= 0.5;
    }
    uvec3 mantissa = uvec3(floor(c * scale + 0.5));
    return mantissa.r | (mantissa.g << 9) | (mantissa.b << 18) | (uint(shared_exponent) << 27);
}

vec3 rgb9e5_unpack(uint code) {
    float scale = exp2(float(int(code >> 27) - RGB9E5_BIAS - RGB9E5_MANTISSA_BITS));
    return vec3(code & 511u, (code >> 9) & 511u, (code >> 18) & 511u) * scale;
}

// Unit vector as three 8 bit signed integers, the longest in its direction that fits, so that the
// rounding is smallest [inferred: the decoder normalizes, hence the length is free].
uint normal_snorm8_pack(vec3 n) {
    float largest = max(max(abs(n.x), abs(n.y)), max(abs(n.z), 1e-20));
    return packSnorm4x8(vec4(n / largest, 0.0)) & 0x00ffffffu;
}

// The bit, of six, of the side of a surface that a line along an axis meets: +x -x +y -y +z -z.
uint side_met(int axis, vec3 normal) { return 1u << (2 * axis + int(normal[axis] < 0.0)); }

// Height of a surface over the lattice point of its voxel along its normal, within half a finest voxel: two
// bits, to an eighth.
uint surface_height_code(float voxels) { return uint(clamp(floor((voxels + 0.5) * 4.0), 0.0, 3.0)); }
float surface_height_voxels(uint code) { return (float(code) + 0.5) / 4.0 - 0.5; }

vec3 normal_snorm8_unpack(uint code) {
    vec3 n = unpackSnorm4x8(code & 0x00ffffffu).xyz;
    float squared = dot(n, n);
    return squared > 0.0 ? n * inversesqrt(squared) : vec3(0.0);
}

// World normal in three 10 bit channels. n * 0.5 + 0.5 of [Mittring12] shifted by half a step, so
// that 0 has a code, and stretched to the unit cube, which the normalizing decoder undoes: the
// axes are exact and the largest error falls from 0.094 to 0.077 degrees.
const float NORMAL10_ZERO = 512.0 / 1023.0;
const float NORMAL10_SCALE = 511.0 / 1023.0;

vec3 normal10_encode(vec3 n) {
    float largest = max(max(abs(n.x), abs(n.y)), max(abs(n.z), 1e-20));
    return n / largest * NORMAL10_SCALE + NORMAL10_ZERO;
}

vec3 normal10_decode(vec3 code) {
    return normalize((code - NORMAL10_ZERO) / NORMAL10_SCALE);
}

// Octahedral map: unit sphere to the square -1..1 [Cigolle14]. Coordinates past the border fold
// back onto the sphere, which is what a filtered lookup there needs.
vec2 octahedral_encode(vec3 direction) {
    vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    vec2 folded = (1.0 - abs(d.yx)) * vec2(d.x >= 0.0 ? 1.0 : -1.0, d.y >= 0.0 ? 1.0 : -1.0);
    return d.z >= 0.0 ? d.xy : folded;
}

vec2 octahedral_fold(vec2 p) {
    vec2 q = p;
    if (abs(q.x) > 1.0) q = vec2(sign(q.x) * 2.0 - q.x, -q.y);
    if (abs(q.y) > 1.0) q = vec2(-q.x, sign(q.y) * 2.0 - q.y);
    return q;
}

vec3 octahedral_decode(vec2 p) {
    vec3 d = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (d.z < 0.0)
        d.xy = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return normalize(d);
}

// Solid angle of a patch of the octahedral square, up to a constant: the octahedron's face turns
// away and recedes, |q|^-3 for q on |x| + |y| + |z| = 1.
float octahedral_weight(vec2 p) {
    vec3 q = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (q.z < 0.0) q.xy = 1.0 - abs(p.yx);
    float squared = dot(q, q);
    return inversesqrt(squared) / squared;
}
