// A grid of cells with a bit for each light: whether it may reach the cell. Flat bit arrays
// [Drobot17 "Improved Culling for Tiled and Clustered Rendering"] can't overflow, and keep the
// order of the lights, so that sums round as without them.

layout(std140) uniform LightCells {
    uvec3 count;             // cells along x, y and depth, or z
    uint words;              // of a cell, each for 32 lights
    vec3 origin_ws;          // WORLD_CELLS: lowest corner
    float cell_m;            // WORLD_CELLS: side of a cell
    vec2 tangents;           // VIEW_CELLS: of the half angles of the view
    float first_depth_m;     // VIEW_CELLS: where the first slice ends and the even octaves begin
    float slices_an_octave;  // VIEW_CELLS
} u_light_cells;

// Texels a row of the texture that holds the words.
const uint LIGHT_BITS_WIDTH = 2048u;

ivec2 light_word_texel(uint word) {
    return ivec2(word % LIGHT_BITS_WIDTH, word / LIGHT_BITS_WIDTH);
}
