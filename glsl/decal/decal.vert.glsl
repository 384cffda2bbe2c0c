// The boxes of decals, drawn by their inner sides, so that an eye inside one sees it.
#include "lib/texels.glsl"
#include "shared/decal.glsl"
#include "shared/view.glsl"

uniform usamplerBuffer u_decals;  // Decals: drivers may have no storage blocks here

in uint a_decal;

flat out uint v_decal;

void main() {
    v_decal = a_decal;
    vec3 corner = vec3(gl_VertexID & 1, (gl_VertexID >> 1) & 1, gl_VertexID >> 2) - 0.5;
    mat4 world_from_decal = texel_matrix(u_decals, a_decal * DECAL_TEXELS + DECAL_WORLD_TEXEL);
    gl_Position = u_view.clip_from_world * (world_from_decal * vec4(corner, 1.0));
}
