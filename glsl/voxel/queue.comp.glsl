// What the fragment queue's consumers need to know, once it is filled. One thread.

#include "lib/dispatch_args.glsl"

layout(local_size_x = 1) in;

layout(std430) buffer State { OctreeState octree_state; };

void main() {
    uint kept = min(octree_state.fragment_count, u_octree.fragment_capacity);
    octree_state.fragments = dispatch_args(kept, FRAGMENT_GROUP);
    octree_state.fragment_dropped = octree_state.fragment_count - kept;
}
