// World positions on the octree's finest lattice.

#include "shared/octree.glsl"

// In lattice points from the scene's corner.
vec3 scene_point_from_world(vec3 p_ws) {
    return (p_ws - u_octree.origin_size.xyz) / u_octree.voxel_m - 0.5 * float(u_octree.resolution);
}

vec3 world_from_scene_point(vec3 point) {
    return (point + 0.5 * float(u_octree.resolution)) * u_octree.voxel_m + u_octree.origin_size.xyz;
}
