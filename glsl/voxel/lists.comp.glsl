// The dispatches over the lists of voxels, and with LISTS_DIRTY of bricks, once their lengths are known.
// A thread a list.

#include "lib/dispatch_args.glsl"

#ifndef LISTS_DIRTY
#define LISTS_DIRTY 0
#endif

layout(local_size_x = 16) in;

layout(std430) buffer State { OctreeState octree_state; };

void main() {
    int level = int(gl_LocalInvocationID.x);
    if (level < u_octree.leaf_level) {
        uint voxels = octree_state.level_voxels[level].threads;
        octree_state.level_voxels[level] = dispatch_args(voxels, BRICK_GROUP);
    } else if (level == u_octree.leaf_level) {
        octree_state.leaf_voxels = dispatch_args(octree_state.leaf_voxels.threads, BRICK_GROUP);
    }
#if LISTS_DIRTY
    if (level == u_octree.leaf_level + 1) {
        octree_state.interior_bricks = dispatch_args(octree_state.interior_bricks.threads, BRICK_GROUP);
    } else if (level == u_octree.leaf_level + 2) {
        octree_state.leaf_bricks = dispatch_args(octree_state.leaf_bricks.threads, BRICK_GROUP);
    }
#endif
}
