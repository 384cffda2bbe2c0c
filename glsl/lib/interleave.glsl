// The 3x3 pattern: pixel p traces cone (p mod 3); the cones' sub-images stand 3x3 in one texture.

ivec2 cone_offset(int cone) { return ivec2(cone % 3, cone / 3); }
int cone_of_pixel(ivec2 pixel) { return pixel.x % 3 + 3 * (pixel.y % 3); }
ivec2 sub_image_size(ivec2 size) { return (size + 2) / 3; }

// Which of a group's four cones, where they are dealt out too: 2x2 patterns hold all of them.
ivec2 part_offset(int part) { return ivec2(part & 1, part >> 1); }
int part_of_pixel(ivec2 pixel) {
    ivec2 pattern = (pixel / 3) & 1;
    return pattern.x + 2 * pattern.y;
}

// Where a pixel's sample stands.
ivec2 sub_image_texel(ivec2 pixel, ivec2 size) {
    return pixel / 3 + sub_image_size(size) * (pixel % 3);
}

// What a thread of a dispatch over (x, y) of a sub-image and the nine works on.
struct InterleavedPixel {
    ivec2 pixel;
    int cone;
    ivec2 texel;   // where its result stands
    bool inside;   // of the image
};

InterleavedPixel interleaved_pixel(uvec3 thread, ivec2 size) {
    ivec2 part = sub_image_size(size);
    ivec2 at = ivec2(thread.xy);
    int cone = int(thread.z);
    ivec2 pixel = at * 3 + cone_offset(cone);
    bool inside = all(lessThan(at, part)) && all(lessThan(pixel, size));
    return InterleavedPixel(pixel, cone, at + part * cone_offset(cone), inside);
}

// The same where four parts are dealt out: a dispatch over (x, y) of a quarter of a sub-image and
// the nine by four, so that neighbouring threads still walk the same way.
InterleavedPixel interleaved_part(uvec3 thread, ivec2 size, out int part) {
    part = int(thread.z) & 3;
    uvec2 at = thread.xy * 2u + uvec2(part_offset(part));
    return interleaved_pixel(uvec3(at, thread.z >> 2u), size);
}
