// One triangle over the whole target, and the exposure of the picture: the adapted brightness is
// read here, once, and handed on. [Mittring12 "Eye Adaptation": "Read result in tone mapping VS,
// pass to PS as interpolator"]
#include "shared/exposure.glsl"

layout(std140) uniform EyeState { Eye eye; };  // laid out as in a storage block

flat out float v_exposure;

void main() {
    v_exposure = u_exposure.bias / eye.brightness;
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
