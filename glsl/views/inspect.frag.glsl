// A target as the buffer viewer shows it: one or three channels over a range, texels as squares.
#include "lib/false_color.glsl"
#include "lib/finite.glsl"
#include "lib/inspect.glsl"
#include "lib/tonemap.glsl"

const uint CHANNEL_RGB = 0u;
const uint CHANNEL_LUMINANCE = 5u;  // 1 to 4: R, G, B, A alone
const uint COLORS_PLAIN = 0u;
const uint COLORS_ENCODED = 1u;     // linear light as sRGB codes
const uint COLORS_FALSE = 2u;
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);  // Rec. 709
const vec3 NOT_A_NUMBER = vec3(1.0, 0.0, 1.0);
const float CHECKER_PX = 8.0;

out vec4 o_color;

vec3 outside() {
    vec2 cell = mod(floor(gl_FragCoord.xy / CHECKER_PX), 2.0);
    return vec3(cell.x == cell.y ? 0.05 : 0.06);
}

void main() {
    ivec2 texel = ivec2(floor(u_inspect.corner + gl_FragCoord.xy * u_inspect.step));
    if (!is_inside(texel)) {
        o_color = vec4(outside(), 1.0);
        return;
    }
    vec4 values = source_texel(texel);
    vec3 shown = values.rgb;
    if (u_inspect.channel == CHANNEL_LUMINANCE) {
        shown = vec3(dot(values.rgb, LUMINANCE));
    } else if (u_inspect.channel != CHANNEL_RGB) {
        shown = vec3(values[u_inspect.channel - 1u]);
    }
    bool broken = is_fault(shown.r) || is_fault(shown.g) || is_fault(shown.b);
    shown = (shown - u_inspect.low) / (u_inspect.high - u_inspect.low);
    if (u_inspect.colors == COLORS_ENCODED) {
        shown = srgb_encode(clamp(shown, 0.0, 1.0));
    } else if (u_inspect.colors == COLORS_FALSE) {
        shown = false_color(u_inspect.channel == CHANNEL_RGB ? dot(shown, LUMINANCE) : shown.r);
    }
    o_color = vec4(broken ? NOT_A_NUMBER : clamp(shown, 0.0, 1.0), 1.0);
}
