// The boxes of decals, drawn by their inner sides, so that an eye inside one sees it.
#include "shared/decal.glsl"
#include "shared/view.glsl"

in uint a_decal;

flat out uint v_decal;

void main() {
    v_decal = a_decal;
    vec3 corner = vec3(gl_VertexID & 1, (gl_VertexID >> 1) & 1, gl_VertexID >> 2) - 0.5;
    gl_Position = u_view.clip_from_world * (decals[a_decal].world_from_decal * vec4(corner, 1.0));
}
