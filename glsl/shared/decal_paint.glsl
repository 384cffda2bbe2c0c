// Which decals colour the fragment queue in one pass, by the cells of a grid over all decals'
// boxes.
const uint DECAL_CELLS_A_SIDE = 16u;

layout(std140) uniform DecalPaint {
    vec3 low_ws;        // of the grid
    uint first_word;    // of this pass in DecalCells: where each cell's decals begin, and the end of all
    vec3 cells_a_metre;
    uint reserved;
} u_decal_paint;

// By pass: the first word of each cell's decals, one more for the end; then the decals' numbers.
layout(std430) readonly buffer DecalCells { uint decal_words[]; };
