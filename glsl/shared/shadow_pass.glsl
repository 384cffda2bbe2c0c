// One drawing of one shadow view.
layout(std140) uniform ShadowPass {
    mat4 clip_from_world;
} u_pass;
