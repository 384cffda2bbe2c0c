/*
help = "glowing cracks in a dark crust, drifting with time"
animated = true
emits = ["glow", "strength"]

[parameters]
glow = { type = "color", default = [1.0, 0.23, 0.03], max = 1, help = "colour of the melt" }
strength = { type = "float", default = 12, min = 0, max = 1e4, unit = "nit", help = "radiance of the hottest melt" }
crust = { type = "color", default = [0.035, 0.03, 0.03], max = 1, help = "colour of what has cooled" }
scale = { type = "float", default = 3, min = 0.01, max = 100, unit = "1/m", help = "plates a metre" }
crack_width = { type = "float", default = 0.16, min = 0, max = 1, help = "share of a plate that glows" }
speed = { type = "float", default = 0.12, min = -10, max = 10, unit = "m/s", help = "how fast the melt drifts upwards" }
pulse = { type = "float", default = 0.35, min = 0, max = 1, help = "how much the glow comes and goes" }
*/
#include "lib/noise.glsl"

void material(inout Surface s, MaterialInput m, Parameters p) {
    // Plates stay; what shines through between them bends their borders and drifts.
    vec3 at = m.position_ws * p.scale;
    vec3 drift = vec3(0.0, -p.speed * m.time_s * p.scale, 0.0);
    vec4 swirl = fractal_noise_d(at * 0.7 + drift, 3);
    vec2 plate = mosaic(at + 0.55 * swirl.xyz * 0.5);
    float heat = 1.0 - smoothstep(0.0, max(p.crack_width, 1e-4), plate.x);
    float flow = 0.55 + 0.45 * fractal_noise(at * 2.5 + drift * 3.0, 2);
    float beat = 1.0 - p.pulse * (0.5 + 0.5 * sin(m.time_s * 1.7 + plate.y * 6.2832));
    float glow = heat * heat * flow * beat;
    // Hotter melt is whiter: the colour's weak channels catch up as the square.
    vec3 color = mix(p.glow * p.glow, p.glow, glow);
    vec4 grain = fractal_noise_d(at * 6.0, 4);
    s.albedo = p.crust * (0.6 + 0.8 * plate.y) * (0.8 + 0.4 * grain.w);
    s.roughness = mix(0.75, 0.35, heat);
    s.emissive = color * p.strength * glow;
    s.height_gradient = 0.25 * grain.xyz * (1.0 - heat);
    s.ambient_occlusion = 1.0;
}
