// World position <-> (node, local position): the octree's mapping function.
// [Mittring12 "Sparse Voxel Octree"]. Needs `nodes` (shared/octree_buffers.glsl).

#include "shared/octree_buffers.glsl"
#include "lib/dense_nodes.glsl"

struct NodeLocation {
    uint node;    // index into nodes
    uvec3 cell;   // the node's coordinates at `level`
    vec3 local;   // position inside it, 0..1
    int level;    // the level that was reached: the wanted one, or the deepest above it
};

uint child_node(uint tile_plus_one, uvec3 child_cell) {
    uvec3 odd = child_cell & 1u;
    return first_tile_node() + (tile_plus_one - 1u) * 8u + (odd.x | (odd.y << 1) | (odd.z << 2));
}

bool node_has_brick(Node node) { return (node.brick & NODE_BRICK_MASK) != 0u; }
uint node_brick(Node node) { return (node.brick & NODE_BRICK_MASK) - 1u; }
uint node_child(Node node) { return node_has_brick(node) && node.child != NODE_HOLLOW ? node.child : 0u; }
// Whether the node at which a descent ended answers for the wanted level.
bool node_answers(Node node, int reached, int wanted) {
    return node_has_brick(node) && (reached == wanted || node.child != NODE_HOLLOW);
}
float node_scale(Node node) { return exp2(float(int(node.brick >> NODE_SCALE_SHIFT) - NODE_SCALE_BIAS)); }

// Descends from the dense levels towards the node `cell` of `level`; it ends at `index`, at the level
// `reached`.
Node descend(uvec3 cell, int level, out uint index, out int reached) {
    reached = min(level, u_octree.top_level);
    index = dense_node(reached, cell >> uint(level - reached));
    Node node = nodes[index];
    while (reached < level) {
        uint tile = node_child(node);
        if (tile == 0u) break;
        ++reached;
        index = child_node(tile, cell >> uint(level - reached));
        node = nodes[index];
    }
    return node;
}

Node find_node(uvec3 cell, int level, out int reached) {
    uint index;
    return descend(cell, level, index, reached);
}

// Unit position in the octree's cube.
vec3 octree_from_world(vec3 p_ws) { return (p_ws - u_octree.origin_size.xyz) / u_octree.origin_size.w; }

bool inside_octree(vec3 p_oct) {
    return all(greaterThanEqual(p_oct, vec3(0.0))) && all(lessThan(p_oct, vec3(1.0)));
}

// Finest voxels along a voxel of the leaves around a point: more than one in a coarser region.
float leaf_voxels(vec3 p_ws) {
    if (u_octree.coarsest_leaf == u_octree.leaf_level) return 1.0;
    int side = int(REGION_SIDE);
    ivec3 at = ivec3(floor(octree_from_world(p_ws) * float(2 * side))) - side / 2;
    at = clamp(at, 0, side - 1);
    uint region = uint(at.x + side * (at.y + side * at.z));
    uint word = u_octree.coarser_leaves[region >> 6u][(region >> 4u) & 3u];
    return float(1u << ((word >> (2u * (region & 15u))) & 3u));
}

// Metres between the voxels of those leaves.
float leaf_voxel_m(vec3 p_ws) { return leaf_voxels(p_ws) * u_octree.voxel_m; }

// World position and wanted level -> node, local position, level reached. p_ws inside the cube.
NodeLocation octree_locate(vec3 p_ws, int wanted_level) {
    vec3 p_oct = octree_from_world(p_ws);
    NodeLocation at;
    uint side = 1u << wanted_level;
    uvec3 cell = min(uvec3(max(p_oct, 0.0) * float(side)), uvec3(side - 1u));
    descend(cell, wanted_level, at.node, at.level);
    at.cell = cell >> uint(wanted_level - at.level);
    at.local = p_oct * float(1u << at.level) - vec3(at.cell);
    return at;
}

// The way back: local position in a node's cell -> world position.
vec3 octree_position(uvec3 cell, int level, vec3 local) {
    vec3 p_oct = (vec3(cell) + local) / float(1u << level);
    return u_octree.origin_size.xyz + p_oct * u_octree.origin_size.w;
}
