// Filtered HDR values of the levels above the finest: 8 voxels x BRICK_STACKS of four half floats a
// brick.
layout(std430) buffer Sided { uvec2 sided[]; };
