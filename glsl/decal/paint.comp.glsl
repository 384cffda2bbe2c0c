// Colours the fragment queue as decals colour the G-buffer, so that bounced light knows of them.
// One material of one order a pass; a fragment looks through the decals of its cell. MOVING=1: only
// the fragments behind those of what never moves.
#define dFdx(x) (0.0 * (x))  // derivatives over pixels, which artists' code may use, are of no use here
#define dFdy(x) (0.0 * (x))
#define fwidth(x) (0.0 * (x))
vec2 decal_uv_dx = vec2(0.0);
vec2 decal_uv_dy = vec2(0.0);
#define MATERIAL_UV_DX(uv) decal_uv_dx
#define MATERIAL_UV_DY(uv) decal_uv_dy

#include "lib/decal.glsl"
#include "lib/fragment_queue.glsl"
#include "lib/lattice.glsl"
#include "lib/material.glsl"
#include "lib/packing.glsl"
#include "lib/scene_lattice.glsl"
#include "shared/decals.glsl"
#include "shared/decal_paint.glsl"

layout(local_size_x = 128) in;  // FRAGMENT_GROUP

layout(std430) buffer Fragments { VoxelFragment fragments[]; };

// A fragment lies up to so many voxels from the surface that it is of.
const float FRAGMENT_REACH = 0.5;

struct Painted {
    vec3 albedo;
    vec3 emissive;
};

// What a decal makes of a fragment. Of the fragment's face, a voxel wide, it covers a part.
void paint(uint number, vec3 p_ws, vec3 normal_ws, float mask, inout Painted painted) {
    mat4 world_from_decal = decals[number].world_from_decal;
    vec3 size_m = vec3(length(world_from_decal[0]), length(world_from_decal[1]),
                       length(world_from_decal[2]));
    vec3 local = (decals[number].decal_from_world * vec4(p_ws, 1.0)).xyz;
    float voxel_m = u_octree.voxel_m;
    if (abs(local.z) * size_m.z > 0.5 * size_m.z + FRAGMENT_REACH * voxel_m) return;
    float opacity = mask * decals[number].opacity
        * decal_cover(local.xy * size_m.xy, size_m.xy, voxel_m);
    opacity *= decal_fade(normal_ws, normalize(world_from_decal[2].xyz), decals[number].fade_end,
                          decals[number].fade_scale);
    if (opacity <= 0.0) return;
    decal_uv_dx = vec2(voxel_m / size_m.x, 0.0);
    decal_uv_dy = vec2(0.0, voxel_m / size_m.y);
    vec2 uv = clamp(vec2(local.x + 0.5, 0.5 - local.y), 0.0, 1.0);
    Surface s = evaluate_material(MaterialInput(decals[number].material, p_ws, normal_ws, uv, uv,
                                                vec4(1.0), u_material.time_s));
    opacity *= clamp(s.opacity, 0.0, 1.0);
    uint channels = decals[number].channels;
    vec3 albedo = s.albedo + mirrored_share(s.specular_color, s.roughness);
    if ((channels & DECAL_COLOR) != 0u) painted.albedo = mix(painted.albedo, albedo, opacity);
    if ((channels & DECAL_EMISSION) != 0u)
        painted.emissive = mix(painted.emissive, s.emissive, opacity);
}

void main() {
    uint index = queue_index();
    if (!is_queued(index)) return;
    uint code = fragments[index].position;
    float mask = decal_mask_of_position(code);
    if (mask <= 0.0) return;
    vec3 p_ws = world_from_scene_point(vec3(unpack_position(code)));
    vec3 cell = floor((p_ws - u_decal_paint.low_ws) * u_decal_paint.cells_a_metre);
    if (any(lessThan(cell, vec3(0.0))) || any(greaterThanEqual(cell, vec3(DECAL_CELLS_A_SIDE))))
        return;
    uvec3 at = uvec3(cell);
    uint word = u_decal_paint.first_word + (at.z * DECAL_CELLS_A_SIDE + at.y) * DECAL_CELLS_A_SIDE
        + at.x;
    uint end = decal_words[word + 1u];
    uint first = decal_words[word];
    if (first == end) return;

    vec3 normal_ws = normal_snorm8_unpack(fragments[index].normal);
    vec4 albedo = unpackUnorm4x8(fragments[index].albedo);
    Painted painted = Painted(albedo.rgb, rgb9e5_unpack(fragments[index].emissive));
    for (uint k = first; k < end; ++k) paint(decal_words[k], p_ws, normal_ws, mask, painted);
    fragments[index].albedo = packUnorm4x8(vec4(painted.albedo, albedo.a));
    fragments[index].emissive = rgb9e5_pack(painted.emissive);
}
