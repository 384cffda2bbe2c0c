// Half the size: radiance and the signed circle of confusion of what lies nearest.
#include "lib/view.glsl"
#include "lib/finite.glsl"
#include "lib/focus.glsl"

uniform sampler2D u_picture;
uniform sampler2D u_depth;

out vec4 o_color_circle;  // a: radius in px of this target, negative before the focus

void main() {
    ivec2 last = textureSize(u_depth, 0) - 1;
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    float nearest = 1.0;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 pixel = min(first + ivec2(i & 1, i >> 1), last);
        nearest = min(nearest, texelFetch(u_depth, pixel, 0).r);
        sum += finite_radiance(texelFetch(u_picture, pixel, 0).rgb);
    }
    o_color_circle = vec4(0.25 * sum, 0.5 * circle_radius(linear_depth(nearest)));
}
