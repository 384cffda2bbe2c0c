const uint FLARE_GHOSTS = 8u;
const uint SPRITE_COLUMNS = 256u;  // texels a row of the sprites' texture

layout(std140) uniform LensFlare {
    vec4 ghosts[FLARE_GHOSTS];  // rgb: factor; a: size of the copy, negative: mirrored
    float threshold;            // exposed luminance
    float sprite_radius;        // px of the picture's quarter
    float sprite_share;         // of a texel's light in each texel that its sprite covers wholly
    uint capacity;              // sprites
    float brightest;            // exposed light of a sprite: all of them on one texel are a half float
    float reserved0;
    float reserved1;
    float reserved2;
} u_flare;

// A DrawElementsIndirectCommand of one quad a sprite, and what did not fit.
struct SpriteCounts {
    uint indices;
    uint sprites;
    uint first_index;
    int base_vertex;
    uint base_instance;
    uint bright;  // texels above the threshold, sprites or not
    uint reserved0;
    uint reserved1;
};
