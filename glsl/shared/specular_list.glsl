// A list of pixels, y << 16 | x, and the dispatch over it. [Mittring12 "Specular Sampling 2/2":
// State[] and RWScratchColors[]]

const uint SPECULAR_GROUP = 64u;

struct SpecularCounts {
    uint groups_x;
    uint groups_y;
    uint groups_z;
    uint listed;
};

// Pixels whose specular cone is traced next.
layout(std430) buffer SpecularState { SpecularCounts specular; };
layout(std430) buffer SpecularPixels { uint specular_pixels[]; };
