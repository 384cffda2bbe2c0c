layout(std140) uniform Upscale {
    vec2 source_per_target;  // texels of the drawn picture a pixel of the shown one
} u_upscale;
