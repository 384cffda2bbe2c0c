// Makes the leaf voxels dirty whose light a change of casters may have reached: those that see a light
// through one of the changed boxes. A block of 4x4x4 points at a time, which errs on the safe side.
// Some blocks are lit anew whatever changed: gathered light comes round everywhere within a few frames.

#include "lib/dispatch.glsl"
#include "lib/shadow.glsl"
#include "shared/changed_boxes.glsl"
#define DIRTY_ACCESS coherent
#include "lib/dirty.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Points { uint point_words[]; };

// How far from a voxel's point its shadow is looked up, in voxels (light.comp), and rounding.
const float OFFSET_VOXELS = 1.5;
// Reach of the shadow filter and of its shift along the normal, in texels: lib/shadow.glsl.
const float FILTER_TEXELS = SHADOW_KERNEL_RADIUS * (1.0 + SHADOW_OFFSET_BASE) + 3.0;

// Whether origin + t direction, t in 0..end, meets the box.
bool meets_box(vec3 origin, vec3 direction, float end, vec3 low, vec3 high) {
    float first = 0.0;
    float last = end;
    for (int axis = 0; axis < 3; ++axis) {
        if (abs(direction[axis]) < 1e-12) {
            if (origin[axis] < low[axis] || origin[axis] > high[axis]) return false;
            continue;
        }
        float a = (low[axis] - origin[axis]) / direction[axis];
        float b = (high[axis] - origin[axis]) / direction[axis];
        first = max(first, min(a, b));
        last = min(last, max(a, b));
    }
    return first <= last;
}

// Whether light of one source reaches a block around `center` through a changed box.
bool light_changed(Light light, vec3 center, float half_side) {
    if (light.shadow_view < 0) return false;
    vec3 direction = -light.direction_ws;
    float end = 1e30;
    float texel = shadow_views[light.shadow_view].texel;
    if (light.kind != LIGHT_DIRECTIONAL) {
        direction = light.position_ws - center;
        end = 1.0;
        float distance_m = length(direction) + 2.0 * half_side;
        if (light.range > 0.0 && distance_m - 4.0 * half_side > light.range) return false;
        texel *= distance_m;
    }
    float grown = half_side + OFFSET_VOXELS * u_octree.voxel_m + FILTER_TEXELS * texel;
    for (int i = 0; i < u_changed.count; ++i) {
        vec3 low = u_changed.low_ws[i].xyz - grown;
        vec3 high = u_changed.high_ws[i].xyz + grown;
        if (meets_box(center, direction, end, low, high)) return true;
    }
    return false;
}

void main() {
    int lattice = u_octree.leaf_level + 1;
    uint block = linear_thread_id();
    if (block >= grid_block_count(lattice)) return;
    uint word = (grid_first_block(lattice) + block) * 2u;
    uvec2 bits = uvec2(point_words[word], point_words[word + 1u]);
    if (bits == uvec2(0u)) return;
    vec3 center = u_octree.origin_size.xyz + (vec3(grid_cell(lattice, block * 64u)) + 1.5) * u_octree.voxel_m;
    bool changed = block >= u_changed.first_block && block < u_changed.end_block;
    for (int i = 0; i < lights.length() && !changed; ++i) {
        changed = light_changed(lights[i], center, 1.5 * u_octree.voxel_m);
    }
    if (!changed) return;
    dirty_words[word] |= bits.x;
    dirty_words[word + 1u] |= bits.y;
}
