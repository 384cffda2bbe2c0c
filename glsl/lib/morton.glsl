// Morton (Z-order) codes of 3D coordinates of up to ten bits.

uint morton_spread(uint x) {
    x &= 0x3ffu;
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    x = (x | (x << 2)) & 0x09249249u;
    return x;
}

uint morton_compact(uint x) {
    x &= 0x09249249u;
    x = (x | (x >> 2)) & 0x030c30c3u;
    x = (x | (x >> 4)) & 0x0300f00fu;
    x = (x | (x >> 8)) & 0x030000ffu;
    x = (x | (x >> 16)) & 0x3ffu;
    return x;
}

uint morton_encode(uvec3 p) {
    return morton_spread(p.x) | (morton_spread(p.y) << 1) | (morton_spread(p.z) << 2);
}

uvec3 morton_decode(uint code) {
    return uvec3(morton_compact(code), morton_compact(code >> 1), morton_compact(code >> 2));
}
