// The octree's read-only views, as every reader of it binds them.

#include "shared/octree.glsl"

layout(std430) readonly buffer Nodes { Node nodes[]; };
