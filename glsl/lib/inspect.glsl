// A texel of any kind of target as four numbers. SOURCE tells the kind.
#ifndef SOURCE
#define SOURCE SOURCE_FLOAT
#endif

#include "shared/inspect.glsl"

#define SOURCE_FLOAT 0
#define SOURCE_UINT 1
#define SOURCE_FLOAT_3D 2
#define SOURCE_UINT_3D 3

#if SOURCE == SOURCE_FLOAT
uniform sampler2D u_source;
#elif SOURCE == SOURCE_UINT
uniform usampler2D u_source;
#elif SOURCE == SOURCE_FLOAT_3D
uniform sampler3D u_source;
#else
uniform usampler3D u_source;
#endif

ivec2 source_size() {
    return textureSize(u_source, 0).xy;
}

bool is_inside(ivec2 texel) {
    return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, source_size()));
}

// Four numbers of a texel inside; unsigned integers as the nearest floats.
vec4 source_texel(ivec2 texel) {
#if SOURCE == SOURCE_FLOAT || SOURCE == SOURCE_UINT
    return vec4(texelFetch(u_source, texel, 0));
#else
    return vec4(texelFetch(u_source, ivec3(texel, u_inspect.slice), 0));
#endif
}
