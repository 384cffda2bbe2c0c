// What the samples of a cone hide of it. [inferred: docs/gi.md#what-hides]
//
// Samples between two clear ones, a run, are of one thing or of things close behind each other, and
// say three things of the share of the cone that these cover.
// The fullest sample: right for a body, for bars and for what lies behind each other; of a wall it
// may say two thirds, where the lattice stands badly.
// The sum of fronts: projected areas add up to what covers the cone, however a sheet lies, and
// trilinear filtering spreads a layer over the way but keeps its sum. What the cone passes by, as a
// wall beside it, adds next to nothing; bodies behind each other count twice, backs not at all.
// The fullest axis: where voxels are closed along one, a wall crosses them, and the fronts' sum is
// that of the part of the wall that the cone has met.
//
// The constants are those of the least errors against rays, see there.

#include "lib/ambient_cube.glsl"

struct Run {
    float fullest;    // sample's opacity
    float fronts;     // sum over the way, in voxels
    float axis;       // fullest along an axis
    float hides;      // share of what arrived at the run
    float arrived;    // share of the cone
};
const Run CLEAR_RUN = Run(0.0, 0.0, 0.0, 0.0, 1.0);

const float FULLEST_OF_WALL = 0.64;   // opacity of the fullest sample of a wall, at least
const float FRONTS_OF_WALL = 1.3;     // sum of fronts of a wall
const float FRONTS_OF_CLOSED = 0.62;  // the same of one whose voxels are closed along an axis
const vec2 CLOSED_AXIS = vec2(0.75, 0.9);  // opacities along it, from maybe closed to closed
const float LEAST_OF_FULLEST = 0.45;  // a run hides this part of its fullest sample in any case,
const float SURELY_HIDES = 0.6;       // and this more where that is surely a wall,
const vec2 SURELY_WALL = vec2(0.55, 0.7);  // by its opacity
// The finest level's voxels stand in steps where the lattice cuts a layer at an angle, and a narrow
// cone meets fewer of them than there are on average.
const float FINEST_FRONTS = 2.5;

// Nearly all or nearly nothing is all or nothing: sums over steps are off by some percent.
float layer_opacity(float covered) { return covered * covered * (3.0 - 2.0 * covered); }

// Adds a sample that stands for so many voxels of the way; returns the share of the cone that it
// hides anew.
float extend(inout Run run, Sight s, float voxels, float lod) {
    run.fullest = max(run.fullest, s.value.a);
    run.fronts += mix(FINEST_FRONTS, 1.0, min(lod, 1.0)) * s.front * voxels;
    run.axis = max(run.axis, s.axis);
    float covers = min(run.fullest / FULLEST_OF_WALL, run.fronts / FRONTS_OF_WALL);
    float is_closed = smoothstep(CLOSED_AXIS.x, CLOSED_AXIS.y, run.axis);
    float closed = min(run.fronts / FRONTS_OF_CLOSED, 1.0) * is_closed;
    float is_wall = smoothstep(SURELY_WALL.x, SURELY_WALL.y, run.fullest);
    float least = LEAST_OF_FULLEST * run.fullest + SURELY_HIDES * is_wall;
    float hides = layer_opacity(min(max(covers, max(closed, least)), 1.0));
    float fresh = run.arrived * max(hides - run.hides, 0.0);
    run.hides = max(run.hides, hides);
    return fresh;
}
