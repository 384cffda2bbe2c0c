// The sparse voxel octree's layout: constants, the uniform block, and the GPU's own counters.
//
// Level l has 2^l nodes a side; its lattice has 2^(l+1) points a side, spaced size / 2^(l+1).
// The scene fills the middle half of the cube along each axis: only so do the coarse levels have
// lattice points on all sides of it, and wide cones see its walls whole.
// Node n owns the 2x2x2 points 2n + {0,1}^3 and filters over 2n + {0,1,2}^3.
// [Mittring12 "Sparse Voxel Octree"]
#include "shared/scan.glsl"

const uint NODE_BRICK_MASK = 0x00ffffffu; // low 24 bits of Node.brick: brick index + 1, 0 = empty
const uint BRICK_LEAF = 0x80000000u;
const uint NODE_SCALE_SHIFT = 24u;     // high 8 bits: the brick's HDR multiplier is 2^(code - 128)
const int NODE_SCALE_BIAS = 128;
const uint BRICK_VOXELS = 8u;          // 2x2x2
const uint BRICK_SIDE = 3u;            // 3x3x3 with the redundant border
const uint BRICK_DIRECTIONS = 6u;      // +x -x +y -y +z -z: the side of the voxel that one looks at
                                       // (the finest level keeps colour and normal instead)
const uint BRICK_STACKS = 7u;          // the six sides, then the opacities along x, y and z
const uint FRAGMENT_GROUP = 128u;      // threads a group over the fragment queue
const uint BRICK_GROUP = 64u;          // threads a group over bricks and their voxels
const uint SCAN_BLOCKS = 2048u;        // 64-node blocks that one such group sums
const uint REGION_SIDE = 8u;           // the scene is split into 8^3 regions, each with its leaf level
const int REGION_LEVEL = 4;            // nodes of this level are as large as a region

// A node is two words.
// brick: see NODE_BRICK_MASK. child, where there is a brick: the leaf brick's slot + 1 on the finest
// level; above it the index of the tile of eight children + 1, or NODE_HOLLOW where no child is
// there (finer levels are empty), or 0 for a leaf of a coarser region, which answers for finer levels
// too. child, where there is no brick: the level of the largest empty ancestor.
const uint NODE_HOLLOW = 0xffffffffu;
struct Node {
    uint child;
    uint brick;
};

// One rasterized sample of a surface. position: 10:10:10 coordinates on the finest lattice from the
// scene's corner, and 2 bits: the share of decals that it takes; albedo: RGBA8, a = opacity;
// normal: snorm8 xyz, high byte: the bit of the side that its lattice line meets and the surface's height
// over the lattice point along the normal, see surface_height_code; emissive: RGB9E5 radiance.
struct VoxelFragment {
    uint position;
    uint albedo;
    uint normal;
    uint emissive;
};

// Averages over a voxel's fragments, 12 bytes: GI-03's "material attributes, normal".
// normal: snorm8 xyz, whose length tells how much the fragments agree; high byte: a bit for each side,
// +x -x +y -y +z -z, that a lattice line meets here, and the mean height. Over many leaves of a surface the
// number of sides is its projected area along the axis, whatever its normal and however thin it is.
struct VoxelAttributes {
    uint albedo;
    uint normal;
    uint emissive;
};
const uint SIDES_MET_SHIFT = 24u;
const uint SIDES_MET_MASK = 0x3fu;
const uint HEIGHT_SHIFT = 30u;

// Where a brick belongs. cell: 9:9:9 node coordinates, 4 bits of level, top bit: a leaf.
// node: 24 bits of node index, 8 bits that say which of its own 2x2x2 points hold anything.
struct Brick {
    uint cell;
    uint node;
};
const uint BRICK_NODE_MASK = 0x00ffffffu;
const uint BRICK_POINTS_SHIFT = 24u;

// Where bricks and tiles keep their slots from one build to the next, each kind has slots of its own:
// bricks above the leaves, others above the finest level, the finest bricks, tiles.
const int SLOT_POOLS = 4;
const int TILE_POOL = 3;
struct SlotPool {
    uint first_slot;
    uint first_rank;   // the pool's share of all ranks, of the last build's, and of those kept
    uint first_old;
    uint first_kept;
    uint used;
    uint free_count;   // slots in the list of free ones,
    uint give_from;    // where vanished ones are added to it,
    uint take_from;    // and from where down new ones take theirs
};

struct DispatchArgs {
    uint x;
    uint y;
    uint z;
    uint threads;
};

// What the GPU alone counts and decides; the CPU reads a copy frames later for the HUD and reports.
struct OctreeState {
    uint fragment_count;               // asked for; beyond the capacity they are dropped
    uint fragment_dropped;
    uint tile_count;
    uint tile_dropped;
    uint brick_count;
    uint brick_dropped;
    uint leaf_count;                   // bricks of the levels that may hold leaves
    uint interior_count;               // bricks above the finest level
    uint leaf_asked;                   // what leaf_count and interior_count would be in larger pools
    uint interior_asked;
    uint first_leaf_brick;             // the brick that leaf attributes begin with
    uint first_finest_brick;           // the first of the finest level
    uint still_count;                  // fragments of what never moves: the queue begins with them
    uint fresh;                        // whether all slots were given out anew, by rank
    uint stale;                        // whether they have to be next time: something was dropped
    SlotPool slot_pools[4];            // see SLOT_POOLS
    DispatchArgs moving_fragments;     // a thread a fragment behind the still ones
    DispatchArgs relinked_fragments;   // a thread a still fragment, none unless `fresh`
    DispatchArgs relinked_voxels;      // a thread a voxel of the leaves' pool, none unless `fresh`
    DispatchArgs fragments;
    DispatchArgs interior_bricks;      // a thread a brick above the finest level
    DispatchArgs leaf_bricks;          // a thread a brick of the finest level
    DispatchArgs leaf_voxels;          // a thread an occupied voxel of a leaf
    DispatchArgs level_voxels[10];     // a thread an occupied voxel of this level, above the finest
    uint level_first[12];              // first brick of each level, by rank; [levels] = brick_count
};

layout(std140) uniform Octree {
    vec4 origin_size;    // xyz: world position of lattice point 0; w: side of the cube, m
    int leaf_level;      // the finest
    int top_level;       // up to it nodes are dense and cover the cube, below it only the scene
    int coarsest_leaf;   // the coarsest leaf level that a region asks for
    int resolution;      // lattice points along a side of the scene at the finest level: half the cube's
    float voxel_m;       // metres between points of the finest lattice
    float fixed_point;   // accumulator units a unit of emitted radiance
    uint block_count;    // 64-node blocks of all levels
    uint atlas_side_log2;      // bricks a row and rows a layer of the six-sided atlas, log2
    uint leaf_atlas_side_log2; // the same of the finest level's
    uint fragment_capacity;
    uint tile_capacity;
    uint brick_capacity;
    uint leaf_capacity;      // bricks that can hold leaf attributes
    uint interior_capacity;  // bricks that can hold filtered HDR values
    uint keeps_slots;        // 1: bricks and tiles outlive a build in their slots; 0: a slot is a rank
    uint brick_list;         // word of VoxelList from which bricks are listed
    uvec4 slot_capacity;     // of each slot pool
    vec3 atlas_texel;      // 1 / size in texels
    vec3 leaf_atlas_texel;
    uvec4 coarser_leaves[8]; // two bits a region, x fastest: levels that its leaves are above the finest
} u_octree;
