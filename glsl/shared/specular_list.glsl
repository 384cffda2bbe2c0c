// The pixels whose specular cone is traced, and the dispatch over them.
// [Mittring12 "Specular Sampling 2/2"]
const uint SPECULAR_GROUP = 64u;

layout(std430) buffer SpecularList {
    uint groups_x;
    uint groups_y;
    uint groups_z;
    uint count;
    uint pixels[];  // y << 16 | x
} specular_list;
