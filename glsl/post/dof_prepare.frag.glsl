// Half the size: radiance and the signed circle of confusion of what lies nearest.
#include "lib/view.glsl"
#include "lib/focus.glsl"

uniform sampler2D u_picture;
uniform sampler2D u_depth;

out vec4 o_color_circle;  // a: radius in px of this target, negative before the focus

void main() {
    ivec2 last = textureSize(u_depth, 0) - 1;
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    float nearest = 1.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 pixel = min(first + ivec2(i & 1, i >> 1), last);
        nearest = min(nearest, texelFetch(u_depth, pixel, 0).r);
    }
    vec2 corner = 2.0 * gl_FragCoord.xy / vec2(textureSize(u_picture, 0));
    vec3 color = max(textureLod(u_picture, corner, 0.0).rgb, vec3(0.0));
    o_color_circle = vec4(color, 0.5 * circle_radius(linear_depth(nearest)));
}
