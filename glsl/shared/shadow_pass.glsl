// One drawing of one shadow view.
layout(std140) uniform ShadowPass {
    mat4 clip_from_world;
    // With CUT: what lies between two heights over a plane and what is in a ball casts no shadow.
    vec4 cut_plane;      // unit normal, offset
    vec4 cut_ball;       // centre, radius
    vec2 cut_heights_m;
    vec2 reserved;
} u_pass;
