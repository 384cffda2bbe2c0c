// The camera of the frame before, and for how long the shutter is open between the two.
layout(std140) uniform Motion {
    mat4 prev_clip_from_world;
    float shutter;   // share of the time between the frames
    float most_px;   // half of the longest streak
    uint tile;       // px a side of a tile: no streak reaches farther than to the next one
} u_motion;
