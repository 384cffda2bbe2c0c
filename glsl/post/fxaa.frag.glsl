// Fast approximate antialiasing, after the published description [Lottes09 "FXAA"]: find edges by
// local contrast of luma, classify them as horizontal or vertical, walk to both ends of the edge,
// and shift the lookup across the edge by how near its end is; single pixels are blended by their
// contrast to the neighbourhood.
uniform sampler2D u_image;  // display codes, linear filter
out vec4 o_color;

const float CONTRAST_ABSOLUTE = 0.0312;  // [Lottes09] "visible limit"
const float CONTRAST_RELATIVE = 0.125;   // [Lottes09] "high quality"
const float SUBPIXEL_SHARE = 0.75;       // [Lottes09] default
// Where the walk looks, px: a lookup between two texels tells of both, and what is far shifts
// little. [Lottes09] likewise. Past the last one the end is guessed.
const float SEARCH_PX[5] = float[](1.0, 2.5, 4.5, 7.5, 11.5);
const float SEARCH_GUESS_PX = 16.0;

float luma(vec3 display) {
    return dot(display, vec3(0.299, 0.587, 0.114));
}

float luma_at(vec2 position_px) {
    return luma(textureLod(u_image, position_px / vec2(textureSize(u_image, 0)), 0.0).rgb);
}

// 3x3 lumas, row by row from below; [4] is the pixel.
float lumas[9];

// Share of a pixel to shift by for features smaller than a pixel.
float subpixel_shift(float contrast) {
    float cross_sum = lumas[1] + lumas[3] + lumas[5] + lumas[7];
    float corner_sum = lumas[0] + lumas[2] + lumas[6] + lumas[8];
    float average = (2.0 * cross_sum + corner_sum) / 12.0;
    float share = smoothstep(0.0, 1.0, clamp(abs(average - lumas[4]) / contrast, 0.0, 1.0));
    return share * share * SUBPIXEL_SHARE;
}

bool edge_is_horizontal() {
    float across_rows = abs(lumas[6] - 2.0 * lumas[3] + lumas[0])
        + 2.0 * abs(lumas[7] - 2.0 * lumas[4] + lumas[1])
        + abs(lumas[8] - 2.0 * lumas[5] + lumas[2]);
    float across_columns = abs(lumas[6] - 2.0 * lumas[7] + lumas[8])
        + 2.0 * abs(lumas[3] - 2.0 * lumas[4] + lumas[5])
        + abs(lumas[0] - 2.0 * lumas[1] + lumas[2]);
    return across_rows >= across_columns;
}

// Walks along the edge from start until the luma leaves the edge's own. x: distance in px,
// y: luma difference there.
vec2 walk_edge(vec2 start, vec2 along, float edge_luma, float threshold) {
    for (int i = 0; i < SEARCH_PX.length(); ++i) {
        float difference = luma_at(start + along * SEARCH_PX[i]) - edge_luma;
        if (abs(difference) >= threshold) return vec2(SEARCH_PX[i], difference);
    }
    return vec2(SEARCH_GUESS_PX, 0.0);
}

// Position to read instead of the pixel's own centre.
vec2 shifted_position(vec2 center, float contrast) {
    bool horizontal = edge_is_horizontal();
    float negative = horizontal ? lumas[1] : lumas[3];
    float positive = horizontal ? lumas[7] : lumas[5];
    bool towards_positive = abs(positive - lumas[4]) >= abs(negative - lumas[4]);
    float opposite = towards_positive ? positive : negative;
    vec2 across = (horizontal ? vec2(0.0, 1.0) : vec2(1.0, 0.0)) * (towards_positive ? 1.0 : -1.0);
    vec2 along = horizontal ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    float edge_luma = 0.5 * (opposite + lumas[4]);
    float threshold = 0.25 * abs(opposite - lumas[4]);
    vec2 start = center + 0.5 * across;
    vec2 ahead = walk_edge(start, along, edge_luma, threshold);
    vec2 behind = walk_edge(start, -along, edge_luma, threshold);
    vec2 nearest = ahead.x < behind.x ? ahead : behind;
    // Only the side whose end turns away from the pixel's own luma lies across the edge.
    bool turns_away = (nearest.y < 0.0) != (lumas[4] < edge_luma);
    float shift = turns_away ? 0.5 - nearest.x / (ahead.x + behind.x) : 0.0;
    return center + across * max(shift, subpixel_shift(contrast));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(u_image, 0) - 1;
    float lowest = 1.0;
    float highest = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 neighbour = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
        lumas[i] = luma(texelFetch(u_image, neighbour, 0).rgb);
        if (i % 2 == 0 && i != 4) continue;  // contrast is judged on the pixel's cross
        lowest = min(lowest, lumas[i]);
        highest = max(highest, lumas[i]);
    }
    float contrast = highest - lowest;
    vec4 color = texelFetch(u_image, pixel, 0);
    if (contrast >= max(CONTRAST_ABSOLUTE, CONTRAST_RELATIVE * highest)) {
        vec2 position = shifted_position(vec2(pixel) + 0.5, contrast);
        color.rgb = textureLod(u_image, position / vec2(textureSize(u_image, 0)), 0.0).rgb;
    }
    o_color = color;
}
