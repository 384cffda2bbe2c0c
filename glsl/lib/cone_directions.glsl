// Nine directions that serve every surface normal. [Mittring12 "Diffuse Sampling 2/2": 9 well
// distributed cones in world space]
//
// Found by tools/cone_directions.py: the set and exponent whose normalized weights
// max(0, n . d)^p reproduce the cosine-weighted mean of all environments of spherical harmonics
// order 2 with the smallest error over all normals (1.5-1.8 % rms a coefficient, 6.9 % at worst).

const int CONE_COUNT = 9;
const float CONE_WEIGHT_POWER = 1.27;
const float CONE_HALF_ANGLE = 0.5235987756;  // 30 degrees

const vec3 CONE_DIRECTIONS[CONE_COUNT] = vec3[CONE_COUNT](
    vec3(0.8159, -0.4071, 0.4106), vec3(-0.1106, -0.9863, 0.1224), vec3(-0.4089, -0.4223, -0.8090),
    vec3(-0.9865, -0.1130, 0.1185), vec3(-0.2023, 0.6882, -0.6967), vec3(0.6958, 0.6958, 0.1781),
    vec3(-0.4028, 0.8158, 0.4150), vec3(0.6922, -0.1918, -0.6958), vec3(-0.1075, -0.1087, 0.9882));

float cone_weight(vec3 normal, vec3 direction) {
    return pow(max(dot(normal, direction), 0.0), CONE_WEIGHT_POWER);
}
