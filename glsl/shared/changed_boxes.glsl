// World boxes in which something that casts shadows changed: as it was, and as it is.
const int CHANGED_BOXES_MAX = 32;

layout(std140) uniform ChangedBoxes {
    vec4 low_ws[32];   // xyz
    vec4 high_ws[32];
    int count;
    uint first_block;  // blocks of leaf points that are lit anew in any case
    uint end_block;
} u_changed;
