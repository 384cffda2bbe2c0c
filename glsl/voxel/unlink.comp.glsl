// Forgets all lists of fragments, where voxels got other slots.

#include "lib/dispatch.glsl"
#include "lib/fragment_lists.glsl"
#include "shared/octree.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) writeonly buffer Heads { uint heads[]; };

void main() {
    uint voxel = linear_thread_id();
    if (voxel >= octree_state.relinked_voxels.threads) return;
    heads[head_of_voxel(voxel, STILL_FRAGMENTS)] = 0u;
    heads[head_of_voxel(voxel, MOVING_FRAGMENTS)] = 0u;
}
