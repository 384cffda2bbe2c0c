// The mean that a level of the sky must have.
layout(std140) uniform SkyNormalize {
    vec3 mean;   // radiance
    uint size;   // texels a side, the border included
} u_pass;
