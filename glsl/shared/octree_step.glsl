// What one step of an octree that follows moving things has to do anew.
layout(std140) uniform OctreeStep {
    int everything;  // 1: all voxels and bricks; 0: the dirty ones
} u_step;
