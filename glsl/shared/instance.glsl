const uint INSTANCE_AREA_LIGHT = 1u;      // its emission is in AreaLights, not in its voxels
const uint INSTANCE_REFUSES_DECALS = 2u;

// One placed mesh. Draws find theirs by the per-instance attribute a_instance, in the buffer's
// texels (lib/instance.glsl). A hidden one has matrices of zeros: its triangles have no area.
struct Instance {
    mat4 world_from_local;
    mat4 normal_from_local;  // inverse transpose of the upper 3x3 of world_from_local
    uint material;
    uint flags;  // INSTANCE_*
    uint reserved0;
    uint reserved1;
    mat4 prev_world_from_local;  // world_from_local of the frame before
};

const uint INSTANCE_TEXELS = 13u;       // of 16 bytes each
const uint INSTANCE_NORMAL_TEXEL = 4u;  // the first of each member after world_from_local
const uint INSTANCE_WORDS_TEXEL = 8u;
const uint INSTANCE_PREV_TEXEL = 9u;
