// A box that projects its material along -z onto what it holds: the cube -0.5..0.5 in its own
// space.
const uint DECAL_COLOR = 1u;      // the channels of the surface below that it changes
const uint DECAL_NORMAL = 2u;
const uint DECAL_ROUGHNESS = 4u;
const uint DECAL_EMISSION = 8u;

struct Decal {
    mat4 decal_from_world;
    mat4 world_from_decal;
    uint material;
    uint channels;     // DECAL_*
    float opacity;
    float fade_end;    // cosine of the angle between z and a surface's normal beyond which nothing is
    float fade_scale;  // 1 / the cosines from there to where it is whole
    uint reserved0;
    uint reserved1;
    uint reserved2;
};

const uint DECAL_TEXELS = 10u;      // of 16 bytes each
const uint DECAL_WORLD_TEXEL = 4u;  // the first of world_from_decal
