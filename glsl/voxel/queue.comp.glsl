// What the fragment queue's consumers need to know, once it is filled. One thread.

#include "shared/octree.glsl"
#include "lib/dispatch.glsl"

layout(local_size_x = 1) in;

layout(std430) buffer State { OctreeState octree_state; };

void main() {
    uint kept = min(octree_state.fragment_count, u_octree.fragment_capacity);
    uvec3 groups = linear_dispatch_args(kept, FRAGMENT_GROUP);
    octree_state.fragments = DispatchArgs(groups.x, groups.y, groups.z, kept);
    octree_state.fragment_dropped = octree_state.fragment_count - kept;
}
