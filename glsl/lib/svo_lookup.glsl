// SVOLookupLevel: radiance and occlusion at a position, level and direction.
// [Mittring12 "The Cone Trace function"]

#include "lib/octree.glsl"
#include "lib/brick_atlas.glsl"
#include "lib/ambient_cube.glsl"

// Linear filters: trilinear inside a brick's 3x3x3.
uniform sampler3D u_brick_atlas;  // six sides: radiance x cover / multiplier, cover; then opacities
uniform sampler3D u_leaf_colors;  // premultiplied radiance / multiplier, opacity
uniform sampler3D u_leaf_normals; // mean normal x opacity

// How a ray looks at voxels.
struct ViewOfVoxels {
    vec3 direction;
    uvec3 sides;   // that it sees
    float own;     // opacity that the surface it leaves may have here: see hidden_share
};

ViewOfVoxels view_of_voxels(vec3 direction) {
    return ViewOfVoxels(direction, sides_seen(direction), 0.0);
}

// Four trilinear lookups, one for each side that the ray sees and one for the opacities.
// local: 0..1 in the node. Premultiplied HDR radiance and opacity a voxel of the node's level.
Sight sides_lookup(Node node, vec3 local, ViewOfVoxels view) {
    vec3 at = (vec3(brick_texel(node_brick(node))) + 0.5 + 2.0 * local) * u_octree.atlas_texel;
    vec3 z = at.z + vec3(view.sides * BRICK_SIDE) * u_octree.atlas_texel.z;
    Sight sight = mean_of_sides(
        textureLod(u_brick_atlas, vec3(at.xy, z.x), 0.0), textureLod(u_brick_atlas, vec3(at.xy, z.y), 0.0),
        textureLod(u_brick_atlas, vec3(at.xy, z.z), 0.0),
        textureLod(u_brick_atlas, vec3(at.xy, at.z + float(BRICK_DIRECTIONS * BRICK_SIDE) * u_octree.atlas_texel.z), 0.0).rgb,
        view.direction, view.own);
    sight.value.rgb *= node_scale(node);
    return sight;
}

// The finest level knows the normal, so that its front shows all of its radiance, its back none; where
// a layer has fewer voxels an area, each hides that much more.
Sight leaf_lookup(Node node, vec3 local, ViewOfVoxels view) {
    vec3 at = (vec3(leaf_texel(node.child - 1u)) + 0.5 + 2.0 * local) * u_octree.leaf_atlas_texel;
    vec4 value = textureLod(u_leaf_colors, at, 0.0);
    if (value.a <= 0.0) return NO_SIGHT;
    vec3 normal = textureLod(u_leaf_normals, at, 0.0).xyz / value.a;
    float front = front_visibility(normal, view.direction);
    float area = 1.0 / voxels_an_area(normal);
    float opacity = min(value.a * area, 1.0);
    vec3 shown = value.rgb * (node_scale(node) * front * opacity / value.a);
    float hides = hidden_share(front * opacity, opacity, view.own);
    return Sight(vec4(shown, hides), value.a * area * front_area(normal, view.direction), value.a);
}

Sight node_lookup(Node node, int level, vec3 local, ViewOfVoxels view) {
    if (level == u_octree.leaf_level) return leaf_lookup(node, local, view);
    return sides_lookup(node, local, view);
}

// Mip counts from the finest level. A leaf of a coarser region answers for finer levels too.
vec4 SVOLookupLevel(vec3 Pos, int Mip, vec3 Direction) {
    if (!inside_octree(octree_from_world(Pos))) return vec4(0.0);
    int level = max(u_octree.leaf_level - Mip, 0);
    NodeLocation at = octree_locate(Pos, level);
    Node node = nodes[at.node];
    if (!node_answers(node, at.level, level)) return vec4(0.0);
    return node_lookup(node, at.level, at.local, view_of_voxels(Direction)).value;
}
