// One level of the cone pyramid from the finer one.
layout(std140) uniform SkyPrefilter {
    uint size;          // texels a side, the border included
    uint source_size;
    float half_angle;   // of the blur, radians
    float reserved0;
} u_pass;
