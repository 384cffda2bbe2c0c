// Whether a neighbouring pixel lies on the same surface. [Mittring12 "Diffuse Sampling 2/2": weight
// by normal and depth]

// A neighbour counts while its distance from the pixel's tangent plane is below this share of its
// distance from the eye.
const float PLANE_TOLERANCE = 0.01;
// What any neighbour counts at least: a pixel without similar ones is filled, not black.
const float LEAST_SIMILARITY = 1e-4;

float inverse_plane_tolerance(vec3 p_ws) {
    return 1.0 / (PLANE_TOLERANCE * distance(p_ws, u_view.eye_ws));
}

// 1 on the pixel's tangent plane, 0 off it.
float plane_similarity(vec3 other_ws, vec3 p_ws, vec3 normal, float inverse_tolerance) {
    return max(1.0 - abs(dot(other_ws - p_ws, normal)) * inverse_tolerance, 0.0);
}

// 1 for the same normal; the cosine counts to the eighth power.
float normal_similarity(vec3 other, vec3 normal) {
    float cosine = max(dot(normal, other), 0.0);
    cosine *= cosine;
    cosine *= cosine;
    return cosine * cosine;
}
