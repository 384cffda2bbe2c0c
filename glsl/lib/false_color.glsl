// Scalars as colours.

// Black, blue, magenta, orange, yellow, white over 0..1, rising in luminance throughout, so that
// the picture still reads in grey. [inferred]
vec3 false_color(float x) {
    const vec3 stops[6] = vec3[6](vec3(0.0), vec3(0.05, 0.1, 0.5), vec3(0.55, 0.1, 0.6),
                                  vec3(0.95, 0.4, 0.2), vec3(1.0, 0.85, 0.3), vec3(1.0));
    float position = clamp(x, 0.0, 1.0) * 5.0;
    int stop = min(int(position), 4);
    return mix(stops[stop], stops[stop + 1], position - float(stop));
}
