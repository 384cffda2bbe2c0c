const uint INSTANCE_AREA_LIGHT = 1u;  // its emission is in AreaLights, not in its voxels

// One placed mesh. Draws find theirs by the per-instance attribute a_instance.
struct Instance {
    mat4 world_from_local;
    mat4 normal_from_local;  // inverse transpose of the upper 3x3 of world_from_local
    uint material;
    uint flags;  // INSTANCE_*
    uint reserved0;
    uint reserved1;
};

layout(std430) readonly buffer Instances { Instance instances[]; };
