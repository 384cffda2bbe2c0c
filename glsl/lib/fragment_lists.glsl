// Which fragments a pass over them is about, and where the lists of a voxel begin.

#define STILL_FRAGMENTS 1
#define MOVING_FRAGMENTS 2
#ifndef KEPT_FRAGMENTS
#define KEPT_FRAGMENTS 0
#endif

// Word of Heads for the list of the still or the moving fragments of a voxel.
uint head_of_voxel(uint voxel, int kind) { return voxel * 2u + uint(kind == MOVING_FRAGMENTS); }
