// Filtered HDR values of the levels above the finest: 8 voxels x 6 sides of four half floats a brick.
layout(std430) buffer Sided { uvec2 sided[]; };
