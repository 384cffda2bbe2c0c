/*
help = "shows its base colour, whatever the light (KHR_materials_unlit)"
emits = ["base_color"]

[parameters]
base_color = { type = "rgba", default = [1, 1, 1, 1], max = 1e6, unit = "nit", help = "radiance and opacity" }
base_color_texture = { type = "texture", default = "white", help = "rgb: colour, a: opacity" }
*/

void material(inout Surface s, MaterialInput m, Parameters p) {
    vec4 base_color = base_color_of(m);
    s.opacity = base_color.a;
    make_unlit(s, base_color.rgb);
}
