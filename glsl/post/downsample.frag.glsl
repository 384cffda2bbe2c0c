// Means of 2x2 texels. Texel i of the target covers 2i and 2i + 1 of the source whatever its size,
// so that no energy is gained or lost; beyond the edge the source repeats. Fetched one by one: a
// filter between an infinite texel and others makes what is no number of them.
#include "lib/finite.glsl"

uniform sampler2D u_picture;

out vec4 o_color;

void main() {
    ivec2 last = textureSize(u_picture, 0) - 1;
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = min(first + ivec2(i & 1, i >> 1), last);
        sum += finite_radiance(texelFetch(u_picture, texel, 0).rgb);
    }
    o_color = vec4(0.25 * sum, 1.0);
}
