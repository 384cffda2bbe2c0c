// Before another build of an octree that keeps its slots: no fragments but the still ones, no lists.
// LISTS_ONLY=1: before the lists alone are made anew. One thread.

#include "shared/octree.glsl"

#ifndef LISTS_ONLY
#define LISTS_ONLY 0
#endif

layout(local_size_x = 1) in;

layout(std430) buffer State { OctreeState octree_state; };

void main() {
#if !LISTS_ONLY
    octree_state.fragment_count = octree_state.still_count;
#endif
    octree_state.leaf_voxels.threads = 0u;
    octree_state.interior_bricks.threads = 0u;
    octree_state.leaf_bricks.threads = 0u;
    for (int level = 0; level < u_octree.leaf_level; ++level) octree_state.level_voxels[level].threads = 0u;
}
