// The glossy pixels between those traced first: interpolated or, if that won't do, traced.

#include "shared/specular_list.glsl"

layout(std430) buffer UndecidedState { SpecularCounts undecided; };
layout(std430) buffer UndecidedPixels { uint undecided_pixels[]; };
