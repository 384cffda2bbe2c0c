// Exposed light above the lens flares' threshold, as much as a sprite can have.
#include "shared/exposure.glsl"
#include "shared/lens_flare.glsl"
#include "lib/color.glsl"

layout(std430) readonly buffer EyeState { Eye eye; };

uniform sampler2D u_picture;

// Of a texel by its number, row by row; black beyond the last.
vec3 bright_light(uint texel) {
    uvec2 size = uvec2(textureSize(u_picture, 0));
    if (texel >= size.x * size.y) return vec3(0.0);
    vec3 radiance = texelFetch(u_picture, ivec2(texel % size.x, texel / size.x), 0).rgb;
    vec3 exposed = radiance * u_exposure.bias / eye.brightness;
    float brightness = luminance(exposed);
    vec3 light = min(exposed * (1.0 - u_flare.threshold / brightness), vec3(u_flare.brightest));
    return brightness > u_flare.threshold ? light : vec3(0.0);
}
