// Which axis a voxelization pass looks along.
layout(std140) uniform Voxelize {
    int axis;  // 0, 1, 2: x, y, z
} u_voxelize;
