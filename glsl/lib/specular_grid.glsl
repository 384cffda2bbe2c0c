// The grid of pixels whose specular cones are traced first, one in each cell of COARSE_PIXELS^2.

const int COARSE_PIXELS = 2;  // how far apart they stand along each axis

// Cells whose pixel lies in the picture; one at least.
ivec2 coarse_size(ivec2 size) {
    return max((size - COARSE_PIXELS / 2 + COARSE_PIXELS - 1) / COARSE_PIXELS, 1);
}

ivec2 coarse_pixel(ivec2 cell, ivec2 size) {
    return min(cell * COARSE_PIXELS + COARSE_PIXELS / 2, size - 1);
}

bool in_coarse_grid(ivec2 pixel, ivec2 size) {
    return pixel == coarse_pixel(min(pixel / COARSE_PIXELS, coarse_size(size) - 1), size);
}
