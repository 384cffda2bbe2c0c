/*
help = "glTF's material with pictures of how much light passes, and of how thick the body is"
emits = ["emissive"]
standard = true

[parameters]
transmission_texture = { type = "texture", default = "white", srgb = false, help = "r: multiplies the transmission" }
thickness_texture = { type = "texture", default = "white", srgb = false, help = "g: multiplies the thickness" }
*/

// KHR_materials_transmission, KHR_materials_volume. What does not pass is scattered instead.
void material(inout Surface s, MaterialInput m, Parameters p) {
    s = standard_surface(m);
    float passes = texture(u_transmission_texture, m.uv0).r;
    s.albedo += s.transmission * (1.0 - passes);
    s.transmission *= passes;
    s.thickness *= texture(u_thickness_texture, m.uv0).g;
}
