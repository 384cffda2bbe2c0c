#include "lib/packing.glsl"

// Infinite or not a number, by its bits: compilers may take isnan() for false.
bool is_fault(float x) {
    return (floatBitsToUint(x) & 0x7f800000u) == 0x7f800000u;
}

// Radiance that can be blurred: what is no number, and what is below 0, is black; what overflowed a
// half float is its largest. Selected, not computed: max(NaN, 0) may be either [GLSL 4.30, 8.3].
vec3 finite_radiance(vec3 radiance) {
    return mix(vec3(0.0), min(radiance, vec3(HALF_MAX)), greaterThan(radiance, vec3(0.0)));
}
