// Averages a voxel's fragments into what lighting reads: see link.comp. KEPT_FRAGMENTS: those of what
// never moves together with the others, whose list it ends.

#include "lib/dispatch.glsl"
#include "lib/voxel_list.glsl"
#include "lib/packing.glsl"
#include "lib/fragment_lists.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer State { OctreeState octree_state; };
layout(std430) readonly buffer Fragments { VoxelFragment fragments[]; };
layout(std430) buffer Attributes { VoxelAttributes attributes[]; };
#if KEPT_FRAGMENTS
layout(std430) readonly buffer Links { uint links[]; };
layout(std430) buffer Heads { uint heads[]; };
#endif

uvec4 bytes_of(uint word) { return uvec4(word, word >> 8, word >> 16, word >> 24) & 0xffu; }

struct Sums {
    uint count;
    uint emitting;
    uvec4 albedo;
    ivec3 normal;
    uint height_codes;
    uint sides_met;
    uint sides_emitting;
    uvec3 emitted;
};

// Adds a fragment; returns the link to the next.
uint add_fragment(inout Sums sums, uint index) {
    VoxelFragment fragment = fragments[index];
    ++sums.count;
    sums.albedo += bytes_of(fragment.albedo);
    sums.height_codes += fragment.normal >> HEIGHT_SHIFT;
    uint side = fragment.normal >> SIDES_MET_SHIFT & SIDES_MET_MASK;
    sums.sides_met |= side;
    sums.normal += ivec3(round(normal_snorm8_unpack(fragment.normal) * 127.0));
    uvec3 radiance = uvec3(rgb9e5_unpack(fragment.emissive) * u_octree.fixed_point + 0.5);
    sums.emitted += radiance;
    if (radiance != uvec3(0u)) {
        ++sums.emitting;
        sums.sides_emitting |= side;
    }
#if KEPT_FRAGMENTS
    return links[index];
#else
    return fragment.position;
#endif
}

void main() {
    uint item = linear_thread_id();
    if (item >= octree_state.leaf_voxels.threads) return;
    uint voxel = leaf_voxel_of_item(item);
    Sums sums = Sums(0u, 0u, uvec4(0u), ivec3(0), 0u, 0u, 0u, uvec3(0u));
#if KEPT_FRAGMENTS
    uint moving = head_of_voxel(voxel, MOVING_FRAGMENTS);
    for (uint link = heads[head_of_voxel(voxel, STILL_FRAGMENTS)]; link != 0u;) link = add_fragment(sums, link - 1u);
    for (uint link = heads[moving]; link != 0u;) link = add_fragment(sums, link - 1u);
    heads[moving] = 0u;
#else
    for (uint link = attributes[voxel].albedo; link != 0u;) link = add_fragment(sums, link - 1u);
#endif
    if (sums.count == 0u) return;

    float inverse = 1.0 / float(sums.count);
    VoxelAttributes result;
    result.albedo = packUnorm4x8(vec4(sums.albedo) * (inverse / 255.0));
    result.normal = packSnorm4x8(vec4(vec3(sums.normal) * (inverse / 127.0), 0.0)) & 0x00ffffffu;
    uint height_code = (2u * sums.height_codes + sums.count) / (2u * sums.count);
    result.normal |= sums.sides_met << SIDES_MET_SHIFT | height_code << HEIGHT_SHIFT;
    // Emission is averaged over what emits: a lamp keeps its power where the ceiling that it hangs
    // from shares its voxels. A leaf shows one radiance on all sides: those that only other surfaces
    // cover must not add to the power.
    float sides = float(bitCount(sums.sides_emitting)) / float(max(bitCount(sums.sides_met), 1));
    float scale = sums.emitting > 0u ? sides / (float(sums.emitting) * u_octree.fixed_point) : 0.0;
    result.emissive = rgb9e5_pack(vec3(sums.emitted) * scale);
    attributes[voxel] = result;
}
