// From exposed radiance to display codes: lens, film and grading. docs/post.md has the formulas.
layout(std140) uniform Film {
    mat4 graded_from_scene;  // 3x3: white balance, scene colour tint
    float slope;             // of the film curve's straight part, per decade
    float toe_start;         // log10 of exposed radiance where the toe leaves it
    float toe_scale;         // how far below that the toe ends
    float shoulder_start;    // log10 of exposed radiance where the shoulder leaves it
    float shoulder_scale;    // how far above that the shoulder ends
    float line_height;       // display value of the straight part at log10 = 0
    float vignette;          // tangent of the angle under which the corner is seen
    float grain;
    float grain_jitter_px;
    float fringe;            // how far red is enlarged and blue made smaller, share of the picture
    vec3 lut_scale;          // from a display value to the LUT's coordinate
    float lut_share;
    vec3 lut_offset;
    uint grain_seed;
    vec3 lut2_scale;         // of the other LUT, while volumes blend two
    float lut2_share;
    vec3 lut2_offset;
    float reserved0;
    vec3 dirt_tint;
} u_film;
