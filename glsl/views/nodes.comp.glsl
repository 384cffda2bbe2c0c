// What nodes hold, as false colours: each pixel's ray walks the voxels of one level to the first
// one in a node that holds any, or, for the regions, that is occupied itself.
#ifndef REGIONS
#define REGIONS 0  // 1: the leaf level of the voxel's region; 0: how many of its voxels the node holds
#endif

#include "lib/false_color.glsl"
#include "lib/regions.glsl"
#include "lib/voxel_walk.glsl"
#include "shared/voxel_view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer Bricks { Brick bricks[]; };
layout(rgba8) writeonly uniform image2D o_image;

const vec3 BACKGROUND = vec3(0.02);
// Faces towards x and z are darker, so that the shape can be seen, and every second region.
const vec3 FACE_SHADE = vec3(0.7, 1.0, 0.85);
const float REGION_SHADE = 0.75;
const int FINEST_LEVEL = 9;

vec3 region_color(ivec3 cell, int node_level) {
    int level = leaf_level_of_cell(cell, node_level);
    ivec3 region = cell >> max(node_level - REGION_LEVEL, 0);
    float shade = ((region.x + region.y + region.z) & 1) == 0 ? 1.0 : REGION_SHADE;
    return shade * false_color(float(level - REGION_LEVEL) / float(FINEST_LEVEL - REGION_LEVEL));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    VoxelWalk walk = begin_walk((vec2(pixel) + 0.5) * u_view.viewport_px.zw, u_voxel_view.level);
    vec3 color = BACKGROUND;
    for (int i = 0; i < WALK_STEPS_MAX && walk_inside(walk); ++i) {
        int reached;
        Node node = find_node(walk.point >> 1u, walk.level, reached);
        uint held = node_answers(node, reached, walk.level)
            ? bricks[node_brick(node)].node >> BRICK_POINTS_SHIFT : 0u;
#if REGIONS
        uvec3 odd = (walk.point >> uint(walk.level - reached)) & 1u;
        held &= 1u << (odd.x | (odd.y << 1) | (odd.z << 2));
#endif
        if (held != 0u) {
#if REGIONS
            color = region_color(ivec3(walk.point >> 1u), walk.level);
#else
            color = false_color(float(bitCount(held)) / float(BRICK_VOXELS));
#endif
            color *= FACE_SHADE[walk.entered];
            break;
        }
        walk_on(walk);
    }
    imageStore(o_image, pixel, vec4(color, 1.0));
}
