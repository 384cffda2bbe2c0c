// How one level of a target is looked at.
layout(std140) uniform Inspect {
    vec2 corner;       // texel at the picture's bottom left corner
    float step;        // texels a pixel
    float low;         // shown as 0
    float high;        // shown as 1
    uint channel;      // CHANNEL_... of lib/inspect.glsl
    uint colors;       // COLORS_...
    int slice;         // of a 3D texture
    ivec2 probe;       // texel whose values are told
} u_inspect;
