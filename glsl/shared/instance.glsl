const uint INSTANCE_AREA_LIGHT = 1u;      // its emission is in AreaLights, not in its voxels
const uint INSTANCE_REFUSES_DECALS = 2u;

// One placed mesh. Draws find theirs by the per-instance attribute a_instance. A hidden one has
// matrices of zeros: its triangles have no area.
struct Instance {
    mat4 world_from_local;
    mat4 normal_from_local;  // inverse transpose of the upper 3x3 of world_from_local
    uint material;
    uint flags;  // INSTANCE_*
    uint reserved0;
    uint reserved1;
    mat4 prev_world_from_local;  // world_from_local of the frame before
};

layout(std430) readonly buffer Instances { Instance instances[]; };
