// The adaptive specular passes' counters. [Mittring12 "Specular Sampling 2/2": State[]]

const uint SPECULAR_GROUP = 64u;
const int COARSE_PIXELS = 2;  // the pixels traced first stand so far apart along each axis

struct SpecularCounts {
    uint groups_x;  // of the dispatch over the listed pixels
    uint groups_y;
    uint groups_z;
    uint listed;
    uint pixels;    // that show glossy light of their own
};

layout(std430) buffer SpecularState { SpecularCounts specular; };
