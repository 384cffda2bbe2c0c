// The half-res z buffer: distance from the eye's plane in m, 0 where nothing is.
// [Mittring12 "SSAO sampling": half res z buffer]
layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/view.glsl"
#include "shared/gbuffer.glsl"
#include "shared/ssao.glsl"

uniform sampler2D u_depth;
layout(r32f) writeonly uniform image2D o_half_z;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, u_ssao.half_size))) return;
    float depth = texelFetch(u_depth, 2 * texel, 0).r;
    imageStore(o_half_z, texel, vec4(depth == DEPTH_CLEAR ? 0.0 : linear_depth(depth)));
}
