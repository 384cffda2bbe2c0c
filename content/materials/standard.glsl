/*
help = "glTF's metallic-roughness material"
emits = ["emissive"]

[parameters]
base_color = { type = "rgba", default = [1, 1, 1, 1], max = 1, help = "colour and opacity; the texture multiplies it" }
metallic = { type = "float", default = 1, min = 0, max = 1, help = "0: a dielectric, 1: a metal" }
roughness = { type = "float", default = 1, min = 0, max = 1, help = "0: a mirror" }
emissive = { type = "color", default = [0, 0, 0], max = 1e6, unit = "nit", help = "emitted radiance" }
normal_scale = { type = "float", default = 1, min = -8, max = 8, help = "strength of the normal map" }
occlusion_strength = { type = "float", default = 1, min = 0, max = 1, help = "strength of the occlusion map" }
transmission = { type = "float", default = 0, min = 0, max = 1, help = "share of the light that passes: glass" }
ior = { type = "float", default = 1.5, min = 1, max = 3, help = "index of refraction" }
thickness = { type = "float", default = 0, min = 0, max = 1e6, unit = "m", help = "of the body of glass; 0: a thin wall" }
attenuation_color = { type = "color", default = [1, 1, 1], max = 1, help = "of light after the attenuation distance" }
attenuation_distance = { type = "float", default = 0, min = 0, max = 1e6, unit = "m", help = "0: nothing is absorbed" }
base_color_texture = { type = "texture", default = "white", help = "rgb: colour, a: opacity" }
metallic_roughness_texture = { type = "texture", default = "white", srgb = false, help = "g: roughness, b: metallic" }
normal_texture = { type = "texture", default = "flat", srgb = false, help = "tangent space, +y up" }
occlusion_texture = { type = "texture", default = "white", srgb = false, help = "r: ambient occlusion" }
emissive_texture = { type = "texture", default = "white", help = "multiplies the emitted radiance" }
*/

void material(inout Surface s, MaterialInput m, Parameters p) {
    s = standard_surface(m);
}
