// Lists, for each of the three views, the triangles that may cover a pixel's centre there, so that the
// rasterizer and its vertex shader skip the others: at one voxel a triangle five of six.
// [Wihlidal16 "Optimizing the Graphics Pipeline with Compute", small primitive culling]

#include "lib/dispatch.glsl"
#include "lib/scene_lattice.glsl"
#include "shared/instances.glsl"
#include "shared/triangle_lists.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Chunks { TriangleChunk chunks[]; };
layout(std430) readonly buffer Indices { uint indices[]; };
layout(std430) readonly buffer Positions { float positions[]; };
// A command for each draw and view, the views one after the other, and the indices they draw.
layout(std430) buffer Commands { DrawCommand commands[]; };
layout(std430) writeonly buffer Lists { uint lists[]; };

// How far, in voxels, a rasterizer may move a vertex: half a step of the four subpixel bits that
// OpenGL 4.3 guarantees (table 23.54), and as much again for rounding.
const float SNAP = 1.0 / 16.0;

vec3 vertex(uint index, mat4 world_from_local) {
    vec3 p = vec3(positions[index * 3u], positions[index * 3u + 1u], positions[index * 3u + 2u]);
    return scene_point_from_world((world_from_local * vec4(p, 1.0)).xyz);
}

void list_triangle(uint command, uvec3 corners) {
    uint at = commands[command].first_index + atomicAdd(commands[command].count, 3u);
    lists[at] = corners.x;
    lists[at + 1u] = corners.y;
    lists[at + 2u] = corners.z;
}

void main() {
    uint thread = linear_thread_id();
    uint number = thread / TRIANGLE_GROUP;
    if (number >= u_selection.chunk_count) return;
    TriangleChunk chunk = chunks[u_selection.first_chunk + number];
    uint triangle = thread % TRIANGLE_GROUP;
    if (triangle >= chunk.triangles) return;

    uint first = chunk.first_index + triangle * 3u;
    uvec3 corners = uvec3(indices[first], indices[first + 1u], indices[first + 2u]);
    mat4 world_from_local = instances[chunk.instance].world_from_local;
    vec3 a = vertex(chunk.base_vertex + corners.x, world_from_local);
    vec3 b = vertex(chunk.base_vertex + corners.y, world_from_local);
    vec3 c = vertex(chunk.base_vertex + corners.z, world_from_local);
    vec3 low = ceil(min(a, min(b, c)) - SNAP);
    vec3 high = floor(max(a, max(b, c)) + SNAP);
    bvec3 reaches = lessThanEqual(low, high);

    uint draws = uint(commands.length()) / 3u;
    if (reaches.y && reaches.z) list_triangle(chunk.draw, corners);
    if (reaches.z && reaches.x) list_triangle(draws + chunk.draw, corners);
    if (reaches.x && reaches.y) list_triangle(2u * draws + chunk.draw, corners);
}
