// One of three orthographic views along an axis, pixel centres on lattice points.
// [Mittring12 "Voxel Lighting Pipeline": one rasterization pass per axis to avoid holes]

#include "lib/scene_lattice.glsl"
#include "shared/voxelize.glsl"
#include "shared/instance.glsl"

in vec3 a_position;
in vec3 a_normal;
in vec2 a_uv0;
in vec2 a_uv1;
in vec4 a_color;
in mat4 a_world_from_local;  // the Instance: a draw is of one, and attributes are read once for it
in mat4 a_normal_from_local;
in uvec4 a_instance_words;   // material, flags

out vec3 v_point;      // in lattice points from the scene's corner
out vec3 v_position_ws;
out vec3 v_normal_ws;
out vec2 v_uv0;
out vec2 v_uv1;
out vec4 v_color;
flat out uint v_material;
flat out uint v_flags;  // INSTANCE_*

void main() {
    vec3 p_ws = (a_world_from_local * vec4(a_position, 1.0)).xyz;
    v_position_ws = p_ws;
    v_point = scene_point_from_world(p_ws);
    v_normal_ws = mat3(a_normal_from_local) * a_normal;
    v_uv0 = a_uv0;
    v_uv1 = a_uv1;
    v_color = a_color;
    v_material = a_instance_words.x;
    v_flags = a_instance_words.y;
    // The axis becomes depth; (x, y, z) turns cyclically, so no view mirrors another.
    vec3 p = u_voxelize.axis == 0 ? v_point.yzx : u_voxelize.axis == 1 ? v_point.zxy : v_point;
    vec3 clip = vec3((p.xy + 0.5), p.z) / float(u_octree.resolution) * 2.0 - 1.0;
    gl_Position = vec4(clip, 1.0);
}
