#include "shared/decal.glsl"

layout(std430) readonly buffer Decals { Decal decals[]; };
