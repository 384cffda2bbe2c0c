// A Gaussian along one axis, and over it the coarser level, enlarged: [Mittring12 "Bloom"]
// "D' = blur(D, b4) + E'".
#include "lib/packing.glsl"
#include "shared/blur.glsl"

#ifndef COARSER
#define COARSER 0
#endif

uniform sampler2D u_picture;
#if COARSER
uniform sampler2D u_coarser;  // half the size, rounded up
#endif

out vec4 o_color;

const vec3 BRIGHTEST = vec3(0.5 * HALF_MAX);  // leaves room for lens flares

void main() {
    vec2 size = vec2(textureSize(u_picture, 0));
    vec3 sum = u_blur.center * texelFetch(u_picture, ivec2(gl_FragCoord.xy), 0).rgb;
    for (uint i = 0u; i < u_blur.count; ++i) {
        vec2 offset = u_blur.pairs[i].x * u_blur.axis;
        sum += u_blur.pairs[i].y
            * (textureLod(u_picture, (gl_FragCoord.xy + offset) / size, 0.0).rgb
            + textureLod(u_picture, (gl_FragCoord.xy - offset) / size, 0.0).rgb);
    }
    sum *= u_blur.factor;
#if COARSER
    vec2 coarser_px = 0.5 * gl_FragCoord.xy;
    sum += textureLod(u_coarser, coarser_px / vec2(textureSize(u_coarser, 0)), 0.0).rgb;
#endif
    o_color = vec4(min(sum, BRIGHTEST), 1.0);
}
