// What the view of the octree shows.
layout(std140) uniform VoxelView {
    int level;  // of the nodes; a voxel is half a node wide
} u_voxel_view;
