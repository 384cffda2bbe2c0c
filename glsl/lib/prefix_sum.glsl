// Prefix sum of a pair over a work group of SCAN_GROUP threads. [Hillis86 "Data Parallel
// Algorithms"]

#include "shared/scan.glsl"

shared uvec2 scan_sums[SCAN_GROUP];

// The sum over this thread and those before it. Every thread of the group must call this.
uvec2 group_inclusive_sum(uint thread, uvec2 value) {
    scan_sums[thread] = value;
    barrier();
    for (uint stride = 1u; stride < SCAN_GROUP; stride <<= 1) {
        uvec2 left = thread >= stride ? scan_sums[thread - stride] : uvec2(0u);
        barrier();
        scan_sums[thread] += left;
        barrier();
    }
    return scan_sums[thread];
}
