// Constants of screen-space ambient occlusion. Half-res texel h stands for the full-res pixel 2h.
layout(std140) uniform Ssao {
    vec2 view_ray;      // x, y of the view-space ray of depth 1 through clip (1, 1)
    ivec2 half_size;    // texels
    float radius;       // m, of the samples around a point
    float bias;         // m over the tangent plane that occlude nothing
    float intensity;    // share of the occlusion that counts
    float power;
    float fade_end;     // m from the eye, where the effect ends
    float fade_range;   // m before that over which it fades
} u_ssao;
