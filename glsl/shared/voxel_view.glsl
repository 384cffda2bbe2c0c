// What a view of the octree shows.
layout(std140) uniform VoxelView {
    int level;              // of the nodes; a voxel is half a node wide
    vec4 ray;               // xyz: along which voxels are looked at; w: 0 where that is the eye's own ray
} u_voxel_view;
