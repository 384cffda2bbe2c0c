// How many samples a cone takes, as false colours. To be included before lib/cone.glsl, which
// counts.
#define COUNT_CONE_STEPS 1

#include "lib/false_color.glsl"

// White is `most` and more a cone.
vec3 steps_color(int steps, int cones, float most) {
    return false_color(float(steps) / (float(max(cones, 1)) * most));
}
