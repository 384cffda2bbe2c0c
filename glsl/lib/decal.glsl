// What a decal does to a surface, without its textures. [Mittring12 "GBuffer": decal mask]

// A pixel before decals are blended into it: as exact as the G-buffer holds it.
struct Receiver {
    float depth;
    vec3 normal_code;  // of normal10_encode
    float mask;        // 0: takes no decal
};

const float DEPTH24_LAST = 16777215.0;
const float MASK_LAST = 255.0;
const float NORMAL_CODE_LAST = 1023.0;

uvec2 receiver_pack(Receiver r) {
    uint depth = min(uint(round(r.depth * DEPTH24_LAST)), uint(DEPTH24_LAST));
    uvec3 normal = uvec3(r.normal_code * NORMAL_CODE_LAST + 0.5);
    return uvec2(depth << 8 | uint(r.mask * MASK_LAST + 0.5),
                 normal.x | normal.y << 10 | normal.z << 20);
}

Receiver receiver_unpack(uvec2 code) {
    vec3 normal_code = vec3(uvec3(code.y, code.y >> 10, code.y >> 20) & 1023u) / NORMAL_CODE_LAST;
    return Receiver(float(code.x >> 8) / DEPTH24_LAST, normal_code,
                    float(code.x & 255u) / MASK_LAST);
}

// 1 on what faces the decal's z, 0 beyond the angle at which it ends: sides and backs stay clean.
float decal_fade(vec3 normal_ws, vec3 z_ws, float fade_end, float fade_scale) {
    return clamp((dot(normal_ws, z_ws) - fade_end) * fade_scale, 0.0, 1.0);
}

// Share of a square face, `side` m wide around p, that a decal of this size (m) around 0 covers:
// what all faces of a lattice add up to is the decal's area.
float decal_cover(vec2 p, vec2 size, float side) {
    vec2 high = min(p + 0.5 * side, 0.5 * size);
    vec2 low = max(p - 0.5 * side, -0.5 * size);
    vec2 covered = max(high - low, 0.0) / side;
    return covered.x * covered.y;
}

// How a point of the plane through p (relative to the eye), seen along ray, moves as the ray turns
// by ray_step. Near the plane's horizon the step is held within half and double the distance.
vec3 step_in_plane(vec3 p, vec3 normal, vec3 ray, vec3 ray_step) {
    float here = dot(normal, ray);
    float there = dot(normal, ray + ray_step);
    float ratio = there * here > 0.0 ? clamp(here / there, 0.5, 2.0) : 2.0;
    float along = dot(p, ray) / dot(ray, ray);
    return along * (ratio * (ray + ray_step) - ray);
}
