// SVOConeTrace: all light that comes from a direction, within a cone.
// [Mittring12 "Voxel Cone Tracing Concept", "The Cone Trace function"], [Crassin11]

#ifndef COUNT_CONE_STEPS
#define COUNT_CONE_STEPS 0
#endif

#include "lib/svo_lookup.glsl"
#include "lib/cone_run.glsl"

// Content-adaptive steps, in voxels of the cone's level: a long one after a clear sample lands at most
// on the middle of the next surface, a short one never steps over it.
const float CONE_STEP = 0.5;
const float CONE_STEP_CLEAR = 1.0;
const float CONE_CLEAR = 0.02;         // opacity below which a sample counts as clear
const float CONE_OPAQUE = 0.96;        // stop where this much is hidden
const float CONE_SKIP_EPSILON = 0.01;  // finest voxels past the far side of an empty node
const int CONE_STEPS_MAX = 256;
#if COUNT_CONE_STEPS
int cone_steps = 0;  // samples taken by this invocation's cones
#endif
// Cone widths a voxel: a trilinear lookup of a tent-filtered level already sees about two voxels.
const float CONE_FOOTPRINT = 2.0;

// Distance, in finest voxels, from p along direction to where it leaves the cell.
float exit_distance(vec3 p, vec3 inverse_direction, vec3 direction, vec3 cell, float cell_size) {
    vec3 far_side = (cell + step(vec3(0.0), direction)) * cell_size;
    vec3 distances = (far_side - p) * inverse_direction;
    return min(distances.x, min(distances.y, distances.z));
}

Sight scaled(Sight s, float by) { return Sight(s.value * by, s.front * by, s.axis * by); }

struct ConeSample {
    Sight sight;
    float empty_exit; // > 0: nothing up to there
    float leaf;       // finest voxels along one of a coarser region's leaves that was sampled, else 0
};

// Both levels around a fractional one with a single descent. p in finest voxels. One place looks sides up
// for each of the two: a software driver runs what is written for every ray, branches or not.
ConeSample cone_sample(vec3 p, float lod, vec3 direction, vec3 inverse_direction, ViewOfVoxels view) {
    int mip = int(lod);
    int coarse = u_octree.leaf_level - mip - 1;
    uint shift = uint(mip + 2);  // a cell of `coarse` is 2^shift voxels wide
    uvec3 voxel = uvec3(p);
    int reached;
    Node node = find_node(voxel >> shift, coarse, reached);
    uint reached_shift = uint(u_octree.leaf_level - reached + 1);
    bool is_empty = !node_has_brick(node);
    if (is_empty || (reached < coarse && node.child == NODE_HOLLOW)) {
        uint empty_shift = is_empty ? uint(u_octree.leaf_level - int(node.child) + 1) : reached_shift;
        vec3 empty_cell = vec3(voxel >> empty_shift);
        float size = float(1u << empty_shift);
        return ConeSample(NO_SIGHT, exit_distance(p, inverse_direction, direction, empty_cell, size), 0.0);
    }
    vec3 local = p / float(1u << reached_shift) - vec3(voxel >> reached_shift);
    bool dense_child = coarse < u_octree.top_level;
    // A leaf of a coarser region stands for its finer levels too.
    bool is_leaf = reached < coarse || (!dense_child && node.child == 0u);
    float share = is_leaf ? 1.0 : lod - float(mip);  // of the coarse level
    Sight sight = share > 0.0 ? scaled(sides_lookup(node, local, view), share) : NO_SIGHT;
    uvec3 child_cell = voxel >> (shift - 1u);
    float leaf = is_leaf ? 0.5 * float(1u << reached_shift) : 0.0;
    if (is_leaf || (!dense_child && node.child == NODE_HOLLOW)) return ConeSample(sight, 0.0, leaf);
    Node child = nodes[dense_child ? dense_node(coarse + 1, child_cell) : child_node(node.child, child_cell)];
    if (node_has_brick(child)) {
        vec3 child_local = local * 2.0 - vec3(child_cell & 1u);
        Sight fine = scaled(node_lookup(child, coarse + 1, child_local, view), 1.0 - share);
        sight.value += fine.value;
        sight.front += fine.front;
        sight.axis += fine.axis;
    }
    return ConeSample(sight, 0.0, 0.0);
}

// Height over the plane of a surface at which a cone ends: m at the start, and m a metre of the way.
// Samples stay CLEARANCE_VOXELS of their own widths above it; a cone near the plane takes
// narrower ones, or it would find the surface that it comes from and darken it. [inferred]
struct Clearance {
    float start;
    float slope;
};
// More where voxels gather, since each further gather multiplies what is lost.
#ifndef CLEARANCE
#define CLEARANCE 4.0
#endif
const float CLEARANCE_VOXELS = CLEARANCE;
// Voxels: up to here they belong to the surface that a cone leaves, or to one that meets it at an edge: a cone
// that sees their backs came out of them, and passes.
const float NEAR_VOXELS = 2.0;
const Clearance NO_SURFACE = Clearance(1e9, 0.0);

// In finest voxels, as t is.
float height_at(Clearance c, float t) { return c.start / u_octree.voxel_m + c.slope * t; }

// What a march along a cone gathers between two distances from Pos, which is in world space.
// ConeAngle: half the aperture in radians. Radiance, and how much is hidden. The cone's samples stay
// off the surface that it leaves and off the one that it ends at.
vec4 cone_trace_between(vec3 Pos, vec3 Direction, float ConeAngle, float start_m, float end_m,
                        Clearance leaves, Clearance reaches) {
    float side = 2.0 * float(u_octree.resolution);
    vec3 origin = octree_from_world(Pos) * side;
    vec3 guarded = mix(Direction, vec3(1e-6), lessThan(abs(Direction), vec3(1e-6)));
    vec3 inverse_direction = 1.0 / guarded;
    ViewOfVoxels view = view_of_voxels(Direction);
    float widening = 2.0 * tan(ConeAngle);
    float lod_last = float(u_octree.leaf_level) - 1e-3;
    float t = start_m / u_octree.voxel_m;
    float end = end_m / u_octree.voxel_m;
    vec4 gathered = vec4(0.0);
    Run run = CLEAR_RUN;
    float own_voxels = leaf_voxels(Pos);
    float gap = CONE_STEP_CLEAR;  // voxels since the last sample, clear nodes left out
    for (int i = 0; i < CONE_STEPS_MAX && t < end; ++i) {
#if COUNT_CONE_STEPS
        ++cone_steps;
#endif
        float height = height_at(leaves, t);
        view.own = clamp(NEAR_VOXELS + 1.0 - min(height, t) / own_voxels, 0.0, 1.0);
        height = min(height, height_at(reaches, t));
        float width = max(min(widening * t / CONE_FOOTPRINT, height / CLEARANCE_VOXELS), 1.0);
        vec3 p = origin + Direction * t;
        if (any(lessThan(p, vec3(0.0))) || any(greaterThanEqual(p, vec3(side)))) break;
        float lod = min(log2(width), lod_last);
        ConeSample s = cone_sample(p, lod, guarded, inverse_direction, view);
        float sampled = max(width, s.leaf);
        if (s.sight.value.a < CONE_CLEAR) {
            float clear_step = sampled * CONE_STEP_CLEAR;
            float way = s.empty_exit > 0.0 ? max(s.empty_exit + CONE_SKIP_EPSILON, width * CONE_STEP) : clear_step;
            gap = min(way - s.empty_exit, clear_step) / sampled;
            t += way;
            run = CLEAR_RUN;
            run.arrived = 1.0 - gathered.a;
            continue;
        }
        float fresh = extend(run, s.sight, 0.5 * (gap + CONE_STEP), s.leaf > 0.0 ? 1.0 : lod);
        gathered += fresh * vec4(s.sight.value.rgb / s.sight.value.a, 1.0);
        gap = CONE_STEP;
        t += sampled * CONE_STEP;
        if (gathered.a > CONE_OPAQUE) {
            gathered /= gathered.a;
            break;
        }
    }
    return gathered;
}

const float CONE_ENDLESS = 1e30;  // m

// start_m: distance along the cone at which the march begins, the start bias.
vec4 cone_trace_above(vec3 Pos, vec3 Direction, float ConeAngle, float start_m, Clearance clearance) {
    return cone_trace_between(Pos, Direction, ConeAngle, start_m, CONE_ENDLESS, clearance, NO_SURFACE);
}

vec4 cone_trace_from(vec3 Pos, vec3 Direction, float ConeAngle, float start_m) {
    return cone_trace_above(Pos, Direction, ConeAngle, start_m, NO_SURFACE);
}

vec4 SVOConeTrace(vec3 Pos, vec3 Direction, float ConeAngle) {
    return cone_trace_from(Pos, Direction, ConeAngle, 0.0);
}
