/*
help = "glTF's material that light shines through: skin, wax, leaves"
emits = ["emissive"]
standard = true

[parameters]
subsurface = { type = "color", default = [0.55, 0.16, 0.08], max = 1, help = "share of the light that comes out elsewhere: back-lit, around edges" }
amount = { type = "float", default = 1, min = 0, max = 1, help = "of the subsurface colour" }
thickness_texture = { type = "texture", default = "white", srgb = false, help = "r: multiplies the amount, dark where it is thick" }
*/

void material(inout Surface s, MaterialInput m, Parameters p) {
    s = standard_surface(m);
    float thin = texture(u_thickness_texture, m.uv0).r;
    s.subsurface_color = p.subsurface * p.amount * thin;
    s.lighting_model = LIGHTING_SUBSURFACE;
}
