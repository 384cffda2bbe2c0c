// Rec. 709 luminance of linear colour.
float luminance(vec3 linear) { return dot(linear, vec3(0.2126, 0.7152, 0.0722)); }
