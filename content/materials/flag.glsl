/*
help = "cloth that waves in the wind: it is displaced, held where v is 0"
animated = true
displacement_m = 0.25
emits = ["emissive"]
standard = true

[parameters]
height = { type = "float", default = 0.08, min = 0, max = 0.25, unit = "m", help = "of the waves" }
wavelength = { type = "float", default = 0.45, min = 0.05, max = 100, unit = "m", help = "from crest to crest" }
speed = { type = "float", default = 0.8, min = -100, max = 100, unit = "m/s", help = "of the waves" }
wind = { type = "vec3", default = [1, 0.25, 0], min = -1, max = 1, help = "where they run to" }
*/

vec3 displace(MaterialInput m, Parameters p) {
    vec3 wind = p.wind / max(length(p.wind), 1e-3);
    float phase = 6.2832 * (dot(m.position_ws, wind) - p.speed * m.time_s) / p.wavelength;
    float wave = sin(phase) + 0.35 * sin(2.3 * phase + 1.0);
    return m.normal_ws * (p.height * wave * smoothstep(0.0, 0.5, m.uv0.y));
}

void material(inout Surface s, MaterialInput m, Parameters p) {
    s = standard_surface(m);
}
