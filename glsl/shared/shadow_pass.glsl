// One drawing of one shadow view.
layout(std140) uniform ShadowPass {
    uint view;  // index into ShadowViews
} u_pass;
