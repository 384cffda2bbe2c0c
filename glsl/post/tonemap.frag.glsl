// Bloom, fringe, vignette, white balance, film curve, sRGB, grading, grain and dither in one pass.
#include "lib/film.glsl"
#include "lib/finite.glsl"
#include "lib/tonemap.glsl"

#ifndef BLOOM
#define BLOOM 0     // 1: u_bloom, half the size, is added
#endif
#ifndef DIRT
#define DIRT 0      // 1: and once more where the lens is dirty
#endif
#ifndef RESAMPLE
#define RESAMPLE 0  // 1: fringe or jitter move what is read
#endif
#ifndef LUT
#define LUT 0       // 1: three curves, 3: a cube
#endif
#ifndef LUT2
#define LUT2 0      // the same of another one, while volumes blend two
#endif

uniform sampler2D u_scene_color;
#if BLOOM
uniform sampler2D u_bloom;
#endif
#if DIRT
uniform sampler2D u_dirt;
#endif
#if LUT == 1
uniform sampler2D u_lut;
#elif LUT == 3
uniform sampler3D u_lut;
#endif
#if LUT2 == 1
uniform sampler2D u_lut2;
#elif LUT2 == 3
uniform sampler3D u_lut2;
#endif

flat in float v_exposure;
out vec4 o_color;

const vec3 BRIGHTEST = vec3(1e10);      // beyond any exposed light that is a number
const uint GRAIN_STREAM = 0x9e3779b9u;  // apart from the dither's noise
const float GRAIN_AMPLITUDE = 0.5;      // display range at intensity 1 [inferred]

vec3 scene_radiance(ivec2 pixel, vec2 size, vec2 jitter) {
#if RESAMPLE
    vec2 uv = (vec2(pixel) + 0.5 + jitter) / size;
    vec2 outward = (uv - 0.5) * u_film.fringe;
    vec3 radiance = vec3(textureLod(u_scene_color, uv - outward, 0.0).r,
                         textureLod(u_scene_color, uv, 0.0).g,
                         textureLod(u_scene_color, uv + outward, 0.0).b);
#else
    vec3 radiance = texelFetch(u_scene_color, pixel, 0).rgb;
#endif
    return finite_radiance(radiance);
}

vec3 look_up(sampler3D cube, vec3 place) {
    return textureLod(cube, place, 0.0).rgb;
}

vec3 look_up(sampler2D curves, vec3 place) {
    return vec3(textureLod(curves, vec2(place.r, 0.5), 0.0).r,
                textureLod(curves, vec2(place.g, 0.5), 0.0).g,
                textureLod(curves, vec2(place.b, 0.5), 0.0).b);
}

vec3 graded(vec3 display) {
    vec3 result = display;
#if LUT
    vec3 place = display * u_film.lut_scale + u_film.lut_offset;
    result = mix(display, look_up(u_lut, place), u_film.lut_share);
#endif
#if LUT2
    vec3 place2 = display * u_film.lut2_scale + u_film.lut2_offset;
    result += u_film.lut2_share * (look_up(u_lut2, place2) - display);
#endif
    return result;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 size = vec2(textureSize(u_scene_color, 0));
    vec3 noise = vec3(0.0);
    if (u_film.grain + u_film.grain_jitter_px > 0.0) {
        noise = dither_triangular(uvec2(pixel) + uvec2(GRAIN_STREAM, u_film.grain_seed));
    }
    vec3 radiance = v_exposure * scene_radiance(pixel, size, noise.yz * u_film.grain_jitter_px);
#if BLOOM
    vec3 bloom = textureLod(u_bloom, gl_FragCoord.xy * 0.5 / vec2(textureSize(u_bloom, 0)),
                            0.0).rgb;
#if DIRT
    bloom += bloom * u_film.dirt_tint * textureLod(u_dirt, gl_FragCoord.xy / size, 0.0).rgb;
#endif
    radiance += bloom;
#endif
    radiance *= vignette((2.0 * gl_FragCoord.xy - size) / length(size));
    radiance = min(radiance, BRIGHTEST);  // what overflowed a target stays a number
    vec3 developed = film_curve(max(mat3(u_film.graded_from_scene) * radiance, vec3(0.0)));
    vec3 display = graded(srgb_encode(developed));
    display += GRAIN_AMPLITUDE * u_film.grain * noise.x;
    o_color = vec4(display + dither_triangular(uvec2(pixel)) / 255.0, 1.0);
}
