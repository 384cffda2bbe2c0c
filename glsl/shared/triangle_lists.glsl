// The triangles that voxelization has to draw: see voxel/select_triangles.comp.
#include "shared/draw_command.glsl"

const uint TRIANGLE_GROUP = 64u;  // triangles of a chunk at most, threads a group over chunks

// Triangles in a row of one placed mesh.
struct TriangleChunk {
    uint first_index;  // in the scene's indices
    uint triangles;
    uint base_vertex;
    uint instance;
    uint draw;         // whose list takes them: a draw for each instance
};

// Which chunks a pass lists: all, or those of what moves or of what does not.
layout(std140) uniform TriangleSelection {
    uint first_chunk;
    uint chunk_count;
} u_selection;
