/*
help = "snow that lies on whatever faces up, over glTF's material"
emits = ["emissive"]
standard = true

[parameters]
amount = { type = "float", default = 0.6, min = 0, max = 1, help = "0: none, 1: on all but overhangs" }
softness = { type = "float", default = 0.18, min = 0.01, max = 1, help = "how gradually it ends, in cosines of the slope" }
snow_color = { type = "color", default = [0.86, 0.89, 0.94], max = 1, help = "diffuse colour" }
depth_color = { type = "color", default = [0.10, 0.13, 0.18], max = 1, help = "light that comes out of it elsewhere" }
sparkle = { type = "float", default = 0.5, min = 0, max = 1, help = "crystals that mirror" }
grain = { type = "float", default = 18, min = 0.1, max = 1000, unit = "1/m", help = "lumps a metre" }
*/
#include "lib/noise.glsl"

void material(inout Surface s, MaterialInput m, Parameters p) {
    s = standard_surface(m);
    vec4 lumps = fractal_noise_d(m.position_ws * p.grain, 3);
    float ragged = 0.25 * fractal_noise_d(m.position_ws * p.grain * 0.3, 3).w;
    float least = 1.0 - 1.6 * p.amount;  // cosine of the steepest slope that holds snow
    float cover = smoothstep(least, least + p.softness, m.normal_ws.y + ragged);
    cover *= smoothstep(0.0, 0.05, p.amount);
    // A crystal in each cell: few stand so that they mirror.
    vec3 cell = floor(m.position_ws * p.grain * 40.0);
    float crystal = step(1.0 - 0.02 * p.sparkle, hash_cell(cell).x);
    s.albedo = mix(s.albedo, p.snow_color, cover);
    s.specular_color = mix(s.specular_color, vec3(0.02 + 0.3 * crystal), cover);
    s.roughness = mix(s.roughness, mix(0.7, 0.25, crystal), cover);
    s.emissive *= 1.0 - cover;
    s.normal_ts = normalize(mix(s.normal_ts, vec3(0.0, 0.0, 1.0), cover));
    s.height_gradient = 0.12 * lumps.xyz * cover;
    s.subsurface_color = p.depth_color * cover;
    if (cover > 0.5) s.lighting_model = LIGHTING_SUBSURFACE;
}
