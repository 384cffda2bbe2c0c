// A finished picture enlarged by the cubic of [Catmull74], kept between the four texels around: no
// ringing, and a picture of the same size stays as it is.
#include "shared/upscale.glsl"

uniform sampler2D u_image;  // display codes

out vec4 o_color;

vec4 catmull_rom(float t) {
    vec4 powers = vec4(1.0, t, t * t, t * t * t);
    return 0.5 * vec4(dot(powers, vec4(0.0, -1.0, 2.0, -1.0)),
                      dot(powers, vec4(2.0, 0.0, -5.0, 3.0)),
                      dot(powers, vec4(0.0, 1.0, 4.0, -3.0)),
                      dot(powers, vec4(0.0, 0.0, -1.0, 1.0)));
}

void main() {
    vec2 place = gl_FragCoord.xy * u_upscale.source_per_target - 0.5;
    ivec2 base = ivec2(floor(place));
    vec4 across = catmull_rom(fract(place.x));
    vec4 along = catmull_rom(fract(place.y));
    ivec2 last = textureSize(u_image, 0) - 1;
    vec3 sum = vec3(0.0);
    vec3 lowest = vec3(1.0);
    vec3 highest = vec3(0.0);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            ivec2 texel = clamp(base + ivec2(x, y) - 1, ivec2(0), last);
            vec3 color = texelFetch(u_image, texel, 0).rgb;
            sum += across[x] * along[y] * color;
            if ((x == 1 || x == 2) && (y == 1 || y == 2)) {
                lowest = min(lowest, color);
                highest = max(highest, color);
            }
        }
    }
    o_color = vec4(clamp(sum, lowest, highest), 1.0);
}
