// Interpolates the listed pixels between those that are traced already, where these agree; lists the
// others to be traced.
// [Mittring12 "Specular Sampling 1/2": adaptive by specular brightness, depth and normal difference]

#include "lib/glossy.glsl"
#include "lib/show_traced.glsl"
#include "lib/specular_append.glsl"
#include "lib/specular_grid.glsl"
#include "shared/undecided_list.glsl"

layout(local_size_x = 64) in;

layout(rgba16f) uniform image2D u_specular_gi;  // holds the coarse grid's pixels already

// What a coarse pixel's surface may differ by and still stand for another.
const float PLANE_TOLERANCE = 0.01;   // distance from the other's plane, a share of that from the eye
const float NORMAL_TOLERANCE = 0.02;  // radians between the normals,
const float NORMAL_OF_LOBE = 0.25;    // or this share of the cone's half angle
const float LOBE_TOLERANCE = 2.0;     // ratio of the cones' half angles
// Largest difference between the radiances around a pixel, as they reach the eye: a visible step of
// exposed radiance, plus a share of the radiance itself.
const float SPREAD_VISIBLE = 0.02;
const float SPREAD_SHARE = 0.15;

bool stands_for(GlossySurface coarse, GlossySurface s) {
    if (coarse.kind != GLOSSY_CONE) return false;
    float off_plane = abs(dot(coarse.p_ws - s.p_ws, s.normal));
    float turn = distance(coarse.normal, s.normal);
    float ratio = max(coarse.half_angle, s.half_angle) / min(coarse.half_angle, s.half_angle);
    return off_plane < PLANE_TOLERANCE * distance(s.p_ws, u_view.eye_ws)
        && turn < max(NORMAL_TOLERANCE, NORMAL_OF_LOBE * s.half_angle) && ratio < LOBE_TOLERANCE;
}

// Bilinear in the coarse pixels around this one, if all of them stand for it and agree.
bool interpolate(ivec2 pixel, GlossySurface s, out vec4 light) {
    ivec2 size = ivec2(u_view.viewport_px.xy);
    vec2 at = vec2(pixel - COARSE_PIXELS / 2) / float(COARSE_PIXELS);
    ivec2 first = ivec2(floor(at));
    vec2 share = at - vec2(first);
    light = vec4(0.0);
    vec3 low = vec3(HALF_MAX);
    vec3 high = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        vec2 along = mix(1.0 - share, share, vec2(corner));
        float weight = along.x * along.y;
        if (weight <= 0.0) continue;
        ivec2 neighbour = coarse_pixel(clamp(first + corner, ivec2(0), coarse_size(size) - 1), size);
        if (!stands_for(glossy_surface(neighbour), s)) return false;
        vec4 traced = imageLoad(u_specular_gi, neighbour);
        light += weight * traced;
        low = min(low, traced.rgb);
        high = max(high, traced.rgb);
    }
    float n_o_v = clamp(dot(s.normal, normalize(u_view.eye_ws - s.p_ws)), 0.0, 1.0);
    float roughness = roughness_from_specular_power(s.power);
    vec3 shown = u_view.exposure * environment_brdf(s.specular_color, roughness, n_o_v);
    vec3 hidden = SPREAD_VISIBLE + SPREAD_SHARE * shown * light.rgb;
    return all(lessThanEqual(shown * (high - low), hidden));
}

void main() {
    uint item = linear_thread_id();
    if (item >= undecided.listed) return;
    ivec2 pixel = pixel_of_code(undecided_pixels[item]);
    vec4 light;
    if (interpolate(pixel, glossy_surface(pixel), light)) {
        imageStore(u_specular_gi, pixel, light);
        show_traced(pixel, SHOW_INTERPOLATED);
        return;
    }
    append_pixel(pixel);
    show_traced(pixel, SHOW_LISTED);
}
