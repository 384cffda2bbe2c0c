// Four levels of the farthest depths, each texel over 2x2 of the level below: of the depth buffer,
// or with LEVEL = 4 of the pyramid's fourth level. What lies past the source's size counts as
// nearest.
layout(local_size_x = 8, local_size_y = 8) in;

#include "shared/depth_pyramid.glsl"

#if LEVEL == 0
uniform sampler2D u_depth;
#else
layout(r32f) readonly uniform image2D u_finer;
#endif
layout(r32f) writeonly uniform image2D o_level0;
layout(r32f) writeonly uniform image2D o_level1;
layout(r32f) writeonly uniform image2D o_level2;
layout(r32f) writeonly uniform image2D o_level3;

shared float farthest[8][8];

float source(ivec2 texel) {
    if (any(greaterThanEqual(texel, u_pyramid.source_size))) return 0.0;
#if LEVEL == 0
    return texelFetch(u_depth, texel, 0).r;
#else
    return imageLoad(u_finer, texel).r;
#endif
}

// The farthest of 2x2 of what the group has found, where `side` texels of it are left.
float reduced(uvec2 at, uint side) {
    if (any(greaterThanEqual(at, uvec2(side)))) return 0.0;
    uvec2 p = 2u * at;
    return max(max(farthest[p.y][p.x], farthest[p.y][p.x + 1u]),
        max(farthest[p.y + 1u][p.x], farthest[p.y + 1u][p.x + 1u]));
}

// Let the others see what this thread has found.
void share(uvec2 at, float depth) {
    barrier();
    farthest[at.y][at.x] = depth;
    barrier();
}

void main() {
    uvec2 at = gl_LocalInvocationID.xy;
    ivec2 group = ivec2(gl_WorkGroupID.xy);
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    float depth = max(max(source(2 * texel), source(2 * texel + ivec2(1, 0))),
        max(source(2 * texel + ivec2(0, 1)), source(2 * texel + ivec2(1, 1))));
    imageStore(o_level0, texel, vec4(depth));
    share(at, depth);
    depth = reduced(at, 4u);
    if (all(lessThan(at, uvec2(4u)))) imageStore(o_level1, 4 * group + ivec2(at), vec4(depth));
    share(at, depth);
    depth = reduced(at, 2u);
    if (all(lessThan(at, uvec2(2u)))) imageStore(o_level2, 2 * group + ivec2(at), vec4(depth));
    share(at, depth);
    if (at == uvec2(0u)) imageStore(o_level3, group, vec4(reduced(at, 1u)));
}
