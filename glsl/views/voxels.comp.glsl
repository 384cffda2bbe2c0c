// The octree itself: each pixel's ray walks the nodes of one level to the first occupied voxel.

#include "lib/svo_lookup.glsl"
#include "lib/view.glsl"
#include "shared/voxel_view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba16f) writeonly uniform image2D o_image;

const int STEPS_MAX = 2048;
const float STEP_EPSILON = 1e-3;     // of a voxel, past each voxel's far side
const float OCCUPIED = 0.5;          // opacity that stops the ray
const vec3 BACKGROUND = vec3(0.02);

// Distance from p to where the ray leaves the cell.
float cell_exit(vec3 p, vec3 direction, vec3 cell, float size) {
    vec3 far_side = (cell + step(vec3(0.0), direction)) * size;
    vec3 distances = (far_side - p) / direction;
    return min(distances.x, min(distances.y, distances.z));
}

// First distance inside the cube, or -1.
float enter_cube(vec3 origin, vec3 direction, float side) {
    vec3 a = -origin / direction;
    vec3 b = (vec3(side) - origin) / direction;
    vec3 low = min(a, b);
    vec3 high = max(a, b);
    float near = max(max(low.x, low.y), max(low.z, 0.0));
    float far = min(high.x, min(high.y, high.z));
    return near < far ? near : -1.0;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    vec3 direction = eye_ray_ws((vec2(pixel) + 0.5) * u_view.viewport_px.zw);
    direction = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));

    // Voxels of the level are the unit; each spans half a unit either way from its lattice point.
    float side = float(2 << u_voxel_view.level);
    vec3 origin = octree_from_world(u_view.eye_ws) * side + 0.5;
    vec3 color = BACKGROUND;
    ViewOfVoxels view = view_of_voxels(direction);
    float t = enter_cube(origin, direction, side);
    for (int i = 0; t >= 0.0 && i < STEPS_MAX; ++i) {
        vec3 p = origin + direction * (t + STEP_EPSILON);
        if (any(lessThan(p, vec3(0.0))) || any(greaterThanEqual(p, vec3(side)))) break;
        uvec3 point = uvec3(p);
        int reached;
        Node node = nodes[find_node(point >> 1u, u_voxel_view.level, reached)];
        if (node_answers(node, reached, u_voxel_view.level)) {
            uint shift = uint(u_voxel_view.level - reached);
            vec3 local = vec3((point >> shift) & 1u) * 0.5;
            vec4 value = node_lookup(node, reached, local, view);
            if (value.a >= OCCUPIED) {
                color = value.rgb / value.a;
                break;
            }
        }
        t += cell_exit(p, direction, vec3(point), 1.0) + STEP_EPSILON;
    }
    imageStore(o_image, pixel, vec4(color, 1.0));
}
