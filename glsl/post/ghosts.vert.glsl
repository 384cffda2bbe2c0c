// One triangle over the whole target, or none where no sprite was drawn.
#include "shared/lens_flare.glsl"

layout(std140) uniform Sprites { SpriteCounts counts; };  // laid out as in a storage block

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    gl_Position = vec4(counts.sprites > 0u ? corner : vec2(2.0), 0.0, 1.0);
}
