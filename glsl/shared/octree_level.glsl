// The octree level that a per-level pass works on.
layout(std140) uniform OctreeLevel {
    int level;
} u_level;
