// What a lens of some aperture, focused at a distance, makes of a point elsewhere.
layout(std140) uniform Focus {
    float distance;         // m, in focus
    float per_near;         // 1 / m: largest blur is reached this far before it
    float per_far;          // 1 / m: and this far behind it
    float largest_px;       // radius of the largest circle of confusion, px of the picture
} u_focus;
