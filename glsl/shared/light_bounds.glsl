// A sphere around all that each light reaches, by the light's number: centre in the world and
// radius in m, negative where the light reaches everywhere.
layout(std430) readonly buffer LightBounds { vec4 light_bounds[]; };
