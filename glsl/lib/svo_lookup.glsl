// SVOLookupLevel: radiance and occlusion at a position, level and direction.
// [Mittring12 "The Cone Trace function"]

#include "lib/octree.glsl"
#include "lib/brick_atlas.glsl"
#include "lib/ambient_cube.glsl"

uniform sampler3D u_brick_atlas;  // linear filter: trilinear inside a brick's 3x3x3

// Three trilinear lookups, one for each side that the direction sees, weighted by direction.
// local: 0..1 in the node. Premultiplied HDR radiance and opacity a voxel of the node's level.
vec4 brick_lookup(Node node, vec3 local, uvec3 sides, vec3 weights) {
    vec3 at = (vec3(brick_texel(node_brick(node))) + 0.5 + 2.0 * local) * u_octree.atlas_texel;
    vec3 z = at.z + vec3(sides * BRICK_SIDE) * u_octree.atlas_texel.z;
    vec4 value = vec4(0.0);
    if (weights.x > 0.0) value += weights.x * textureLod(u_brick_atlas, vec3(at.xy, z.x), 0.0);
    if (weights.y > 0.0) value += weights.y * textureLod(u_brick_atlas, vec3(at.xy, z.y), 0.0);
    if (weights.z > 0.0) value += weights.z * textureLod(u_brick_atlas, vec3(at.xy, z.z), 0.0);
    return vec4(value.rgb * node_scale(node), value.a);
}

// Mip counts from the finest level. A leaf of a coarser region answers for finer levels too.
vec4 SVOLookupLevel(vec3 Pos, int Mip, vec3 Direction) {
    if (!inside_octree(octree_from_world(Pos))) return vec4(0.0);
    int level = max(u_octree.leaf_level - Mip, 0);
    NodeLocation at = octree_locate(Pos, level);
    Node node = nodes[at.node];
    if (!node_answers(node, at.level, level)) return vec4(0.0);
    return brick_lookup(node, at.local, sides_seen(Direction), side_weights(Direction));
}
