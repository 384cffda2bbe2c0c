// How full the octree's pools are: a bar each, as long as its share that is in use. From the top:
// fragments, tiles of eight nodes, bricks, bricks with leaf attributes, bricks above the finest
// level.

#include "lib/false_color.glsl"
#include "shared/octree.glsl"
#include "shared/view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer State { OctreeState octree_state; };
layout(rgba8) writeonly uniform image2D o_image;

const int POOLS = 5;
const float GAP = 0.15;                      // of a bar's height, above and below it
const vec3 BACKGROUND = vec3(0.02);
const vec3 UNUSED = vec3(0.15);
const vec3 OVERFLOWED = vec3(1.0, 0.0, 0.0);  // what was asked for did not fit
const float FILL_FIRST = 0.25;               // false colour of an empty pool; a full one's is 0.9
const float FILL_LAST = 0.9;

// In use or asked for, and capacity.
vec2 pool_use(int pool) {
    if (pool == 0) return vec2(octree_state.fragment_count, u_octree.fragment_capacity);
    if (pool == 1)
        return vec2(octree_state.tile_count + octree_state.tile_dropped, u_octree.tile_capacity);
    if (pool == 2)
        return vec2(octree_state.brick_count + octree_state.brick_dropped, u_octree.brick_capacity);
    if (pool == 3) return vec2(octree_state.leaf_asked, u_octree.leaf_capacity);
    return vec2(octree_state.interior_asked, u_octree.interior_capacity);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    vec2 uv = (vec2(pixel) + 0.5) * u_view.viewport_px.zw;
    float row = (1.0 - uv.y) * float(POOLS);
    vec3 color = BACKGROUND;
    if (abs(fract(row) - 0.5) < 0.5 - GAP) {
        vec2 use = pool_use(int(row));
        float fill = use.x / max(use.y, 1.0);
        color = uv.x >= fill ? UNUSED : fill > 1.0 ? OVERFLOWED
            : false_color(mix(FILL_FIRST, FILL_LAST, fill));
    }
    imageStore(o_image, pixel, vec4(color, 1.0));
}
