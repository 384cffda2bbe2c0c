// The pixels whose specular cone is traced next, y << 16 | x. [Mittring12 "Specular Sampling 2/2"]
layout(std430) buffer SpecularPixels { uint specular_pixels[]; };
