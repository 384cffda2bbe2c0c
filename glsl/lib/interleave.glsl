// The 3x3 pattern: pixel p traces cone (p mod 3); the cones' sub-images stand 3x3 in one texture.

ivec2 cone_offset(int cone) { return ivec2(cone % 3, cone / 3); }
int cone_of_pixel(ivec2 pixel) { return pixel.x % 3 + 3 * (pixel.y % 3); }
ivec2 sub_image_size(ivec2 size) { return (size + 2) / 3; }

// Where a pixel's sample stands.
ivec2 sub_image_texel(ivec2 pixel, ivec2 size) { return pixel / 3 + sub_image_size(size) * (pixel % 3); }
