#include "shared/instance.glsl"

layout(std430) readonly buffer Instances { Instance instances[]; };
