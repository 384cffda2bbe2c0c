// The camera of the frame. Matrices by composition: p_cs = clip_from_world * p_ws.
layout(std140) uniform View {
    mat4 clip_from_world;
    mat4 world_from_clip;
    mat4 view_from_world;
    mat4 world_from_view;
    vec4 viewport_px;  // width, height, 1 / width, 1 / height
    vec3 eye_ws;
    float exposure;    // multiplies scene-referred radiance before the tone curve
    float near;        // m
    float far;         // m
    float time_s;
    uint frame;
    vec3 indirect;     // multiplies the indirect light that surfaces in view receive
    float subsurface_reach;  // m: thickest body that light shines through
} u_view;
