// The view of which pixels have a specular cone of their own.
#ifndef SHOW_TRACED
#define SHOW_TRACED 0
#endif

#include "lib/false_color.glsl"

// Shares of false_color.
const float SHOW_NONE = 0.0;
const float SHOW_INTERPOLATED = 0.2;
const float SHOW_COARSE = 0.5;  // traced first
const float SHOW_LISTED = 0.9;  // traced because interpolation would not do

#if SHOW_TRACED
layout(rgba8) writeonly uniform image2D o_traced;
#endif

void show_traced(ivec2 pixel, float how) {
#if SHOW_TRACED
    imageStore(o_traced, pixel, vec4(false_color(how), 1.0));
#endif
}
