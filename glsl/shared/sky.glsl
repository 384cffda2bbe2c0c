// The environment's constants; the map itself is described in lib/sky.glsl.
layout(std140) uniform Sky {
    vec3 tint;              // multiplies the map: colour times intensity
    float level_count;
    float size;             // texels a side of level 0, the border included
    float widest_angle;     // cone half angle that the last level holds, radians
} u_sky_params;
