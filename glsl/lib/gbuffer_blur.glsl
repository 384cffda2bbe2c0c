// The G-buffer blur's weights and what it makes of specular power. [Mittring12 "G-buffer Blur"]

// Pixels' widths from the centre's tangent plane at which a neighbour is of another surface. Bumps
// of 45 degrees keep neighbours within one [inferred].
const float BLUR_PLANE_TOLERANCE = 4.0;

// Weighted by normal: the squared cosine leaves the sides of an edge apart, yet lets the bumps of a
// normal map in; and by depth difference, from the tangent plane, so that slanted surfaces count.
float blur_weight(vec3 normal, vec3 other_normal, float off_plane_px) {
    float cosine = max(dot(normal, other_normal), 0.0);
    return cosine * cosine * max(1.0 - off_plane_px / BLUR_PLANE_TOLERANCE, 0.0);
}

// The slide's reduction of specular power [Toksvig05], [Bruneton11]. mean_length: of the weighted
// mean of unit normals; the factor lets the rounding of ten bits through.
const float TOKSVIG_ROUNDING = 1.002;

float toksvig_power(float power, float mean_length) {
    float l = clamp(mean_length * TOKSVIG_ROUNDING, 0.0, 1.0);
    return power * l / (l + power * (1.0 - l));
}
