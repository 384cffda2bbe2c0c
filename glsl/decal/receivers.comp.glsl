// What decals ask of the G-buffer while they are blended into it. Its depth too: that is attached
// then, and GL 4.3 leaves undefined what is read of an attached texture.
layout(local_size_x = 8, local_size_y = 8) in;

#include "lib/decal.glsl"
#include "lib/gbuffer.glsl"
#include "shared/view.glsl"

uniform sampler2D u_depth;
uniform sampler2D u_gbuffer_a;
uniform sampler2D u_gbuffer_c;
layout(rg32ui) writeonly uniform uimage2D o_receivers;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u_view.viewport_px.xy)))) return;
    vec4 a = texelFetch(u_gbuffer_a, pixel, 0);
    bool lit = uint(a.w * LIGHTING_MODEL_SCALE + 0.5) != LIGHTING_UNLIT;
    float depth = texelFetch(u_depth, pixel, 0).r;
    float mask = lit && depth != DEPTH_CLEAR ? texelFetch(u_gbuffer_c, pixel, 0).a : 0.0;
    imageStore(o_receivers, pixel, uvec4(receiver_pack(Receiver(depth, a.xyz, mask)), 0u, 0u));
}
