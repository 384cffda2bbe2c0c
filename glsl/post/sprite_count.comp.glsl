// How many texels of each run of a work group's length are bright enough for a sprite.
layout(local_size_x = 256) in;  // SCAN_GROUP

#include "lib/bright.glsl"
#include "lib/dispatch.glsl"

layout(std430) writeonly buffer RunCounts { uint run_counts[]; };

shared uint bright_count;

void main() {
    if (gl_LocalInvocationIndex == 0u) bright_count = 0u;
    barrier();
    uint texel = linear_thread_id();
    if (bright_light(texel) != vec3(0.0)) atomicAdd(bright_count, 1u);
    barrier();
    if (gl_LocalInvocationIndex == 0u) run_counts[texel / gl_WorkGroupSize.x] = bright_count;
}
