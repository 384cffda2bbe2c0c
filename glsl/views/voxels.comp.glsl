// The octree itself: each pixel's ray walks the voxels of one level to the first that is opaque
// enough.

#include "lib/svo_lookup.glsl"
#include "lib/voxel_walk.glsl"
#include "shared/voxel_view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba16f) writeonly uniform image2D o_image;

const vec3 BACKGROUND = vec3(0.02);

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    VoxelWalk walk = begin_walk((vec2(pixel) + 0.5) * u_view.viewport_px.zw, u_voxel_view.level);
    // Towards the eye, or on the side that was asked for.
    ViewOfVoxels view = view_of_voxels(u_voxel_view.ray.w > 0.0 ? u_voxel_view.ray.xyz
                                       : walk.direction);
    vec3 color = BACKGROUND;
    for (int i = 0; i < WALK_STEPS_MAX && walk_inside(walk); ++i) {
        int reached;
        Node node = find_node(walk.point >> 1u, walk.level, reached);
        if (node_answers(node, reached, walk.level)) {
            vec3 local = vec3((walk.point >> uint(walk.level - reached)) & 1u) * 0.5;
            vec4 value = node_lookup(node, reached, local, view).value;
            if (value.a >= WALK_OPAQUE) {
                color = value.rgb / value.a;
                break;
            }
        }
        walk_on(walk);
    }
    imageStore(o_image, pixel, vec4(color, 1.0));
}
