// An eye's ray through the voxels of one level of the octree: begin, then while inside look at
// `point` and walk on.

#include "lib/octree.glsl"
#include "lib/view.glsl"

const int WALK_STEPS_MAX = 2048;
const float WALK_EPSILON = 1e-3;  // of a voxel, past each voxel's far side
const float WALK_OPAQUE = 0.5;    // opacity that stops a ray

// Voxels of the level are the unit; each spans half a unit either way from its lattice point.
struct VoxelWalk {
    vec3 origin;
    vec3 direction;
    float side;    // of the cube
    float t;       // < 0: the ray misses the cube
    uvec3 point;   // the voxel that it is in
    int level;     // of the nodes
    int entered;   // axis of the face by which it came
};

VoxelWalk begin_walk(vec2 uv, int level) {
    vec3 direction = eye_ray_ws(uv);
    direction = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    float side = float(2 << level);
    vec3 origin = octree_from_world(u_view.eye_ws) * side + 0.5;
    vec3 a = -origin / direction;
    vec3 b = (vec3(side) - origin) / direction;
    vec3 low = min(a, b);
    vec3 high = max(a, b);
    float near = max(max(low.x, low.y), max(low.z, 0.0));
    float far = min(high.x, min(high.y, high.z));
    return VoxelWalk(origin, direction, side, near < far ? near : -1.0, uvec3(0u), level, 0);
}

// Whether the ray is in the cube still; finds the voxel.
bool walk_inside(inout VoxelWalk walk) {
    vec3 p = walk.origin + walk.direction * (walk.t + WALK_EPSILON);
    walk.point = uvec3(max(p, 0.0));
    return walk.t >= 0.0 && all(greaterThanEqual(p, vec3(0.0)))
        && all(lessThan(p, vec3(walk.side)));
}

void walk_on(inout VoxelWalk walk) {
    vec3 p = walk.origin + walk.direction * (walk.t + WALK_EPSILON);
    vec3 far_side = vec3(walk.point) + step(vec3(0.0), walk.direction);
    vec3 distances = (far_side - p) / walk.direction;
    float nearest = min(distances.x, min(distances.y, distances.z));
    walk.entered = nearest == distances.x ? 0 : nearest == distances.y ? 1 : 2;
    walk.t += nearest + WALK_EPSILON;
}
