// Equirectangular image to octahedral map.
layout(std140) uniform SkyProject {
    uint size;      // texels a side, the border included
    uint samples;   // a side of a texel
} u_pass;
