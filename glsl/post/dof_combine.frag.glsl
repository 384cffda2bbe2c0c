// The sharp picture under what is blurred behind and before its focus.
#include "lib/view.glsl"
#include "lib/finite.glsl"
#include "lib/focus.glsl"

uniform sampler2D u_picture;
uniform sampler2D u_depth;
uniform sampler2D u_far;
uniform sampler2D u_near;

out vec4 o_color;

const float BLURRED_PX = 2.0;  // circles of this radius show the half size picture alone

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 half_uv = 0.5 * gl_FragCoord.xy / vec2(textureSize(u_far, 0));
    float radius = circle_radius(linear_depth(texelFetch(u_depth, pixel, 0).r));
    vec4 color = texelFetch(u_picture, pixel, 0);
    color.rgb = finite_radiance(color.rgb);
    vec4 far = textureLod(u_far, half_uv, 0.0);
    float share = smoothstep(SHARP_PX, BLURRED_PX, radius);
    if (share > 0.0 && far.a > 0.0) color.rgb = mix(color.rgb, far.rgb / far.a, share);
    vec4 near = textureLod(u_near, half_uv, 0.0);
    // A surface before the focus hides what is behind it, which no one has seen: it is all near.
    float covered = max(near.a, smoothstep(SHARP_PX, BLURRED_PX, -radius));
    if (near.a > 0.0) color.rgb = mix(color.rgb, near.rgb / near.a, covered);
    o_color = color;
}
