/*
help = "woven cloth: a fuzz of fibres that shines at grazing angles"
emits = ["emissive"]

[parameters]
sheen = { type = "color", default = [0.25, 0.22, 0.3], max = 1, help = "reflectance of the fibres" }
fuzz = { type = "float", default = 0.6, min = 0.05, max = 1, help = "how far the fibres stand apart: the width of the shine" }
threads = { type = "float", default = 60, min = 0, max = 10000, unit = "per uv", help = "threads along the first uv set; 0: no weave" }
weave = { type = "float", default = 0.6, min = 0, max = 2, help = "depth of the weave" }
base_color = { type = "rgba", default = [1, 1, 1, 1], max = 1, help = "colour and opacity" }
emissive = { type = "color", default = [0, 0, 0], max = 1e6, unit = "nit", help = "emitted radiance" }
*/

void material(inout Surface s, MaterialInput m, Parameters p) {
    vec4 base_color = base_color_of(m);
    s.albedo = base_color.rgb;
    s.opacity = base_color.a;
    s.specular_color = p.sheen;
    s.roughness = p.fuzz;
    s.emissive = p.emissive;
    s.lighting_model = LIGHTING_CLOTH;
    // Warp and weft take turns on top, each a half cylinder; it fades where threads get finer than
    // pixels, as their mean is a plane.
    vec2 at = m.uv0 * p.threads;
    float seen = 1.0 - smoothstep(0.25, 0.6, max(fwidth(at.x), fwidth(at.y)));
    vec2 across = fract(at) * 2.0 - 1.0;
    bool warp = mod(floor(at.x) + floor(at.y), 2.0) < 0.5;
    vec2 tilt = warp ? vec2(across.x, 0.35 * across.y) : vec2(0.35 * across.x, across.y);
    s.normal_ts = normalize(vec3(tilt * p.weave * seen, 1.0));
    float valley = dot(across, across) * 0.5;
    s.ambient_occlusion = 1.0 - 0.5 * min(p.weave, 1.0) * seen * valley * valley;
    s.albedo *= mix(1.0, 0.75 + 0.35 * (1.0 - valley), seen * min(p.weave, 1.0));
}
