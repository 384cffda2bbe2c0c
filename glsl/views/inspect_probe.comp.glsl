// The values of one texel, exactly, for the buffer viewer and the pixel inspector.
layout(local_size_x = 1) in;

#include "lib/inspect.glsl"

layout(std430) writeonly buffer Probed {
    vec4 values;
    uvec4 words;  // the same as unsigned integers, where the target holds such
} probed;

void main() {
    bool inside = is_inside(u_inspect.probe);
#if SOURCE == SOURCE_UINT
    uvec4 words = inside ? uvec4(texelFetch(u_source, u_inspect.probe, 0)) : uvec4(0u);
#elif SOURCE == SOURCE_UINT_3D
    uvec4 words = inside ? uvec4(texelFetch(u_source, ivec3(u_inspect.probe, u_inspect.slice), 0))
        : uvec4(0u);
#else
    uvec4 words = uvec4(0u);
#endif
    probed.values = inside ? source_texel(u_inspect.probe) : vec4(0.0);
    probed.words = words;
}
