// The talk's shading formulas and what joins them to metallic-roughness materials.
#include "lib/math.glsl"

// [Mittring12 "New Specular Power Encoding"]: NewEncode, NewDecode.
const float SPECULAR_POWER_CODE_RANGE = 19.0;
const float SPECULAR_POWER_MIN = 0.5;       // code 0
const float SPECULAR_POWER_MAX = 262144.0;  // code 1

float specular_power_encode(float power) {
    return (log2(power) + 1.0) / SPECULAR_POWER_CODE_RANGE;
}

float specular_power_decode(float code) {
    return exp2(code * SPECULAR_POWER_CODE_RANGE - 1.0);
}

// alpha = roughness^2 and the Blinn-Phong power of the same width, 2 / alpha^2 - 2
// [Karis13 "Real Shading in Unreal Engine 4"], held inside what the encoding can say.
float specular_power_from_roughness(float roughness) {
    float alpha_squared = max(roughness * roughness * roughness * roughness, 1e-12);
    return clamp(2.0 / alpha_squared - 2.0, SPECULAR_POWER_MIN, SPECULAR_POWER_MAX);
}

float roughness_from_specular_power(float power) {
    return sqrt(sqrt(2.0 / (power + 2.0)));
}

// [Mittring12 "Gaussian Specular"], after [McKesson12].
const float GAUSSIAN_SPECULAR_THRESHOLD = 0.04;

// 1 - CosAngle with CosAngle = pow(Threshold, 1 / BlinnPhongSpecularPower). The sharp powers have a
// cosine that rounds to 1, hence the series for 1 - exp(-x).
float one_minus_lobe_cosine(float power) {
    float x = -log(GAUSSIAN_SPECULAR_THRESHOLD) / power;
    return x < 0.05 ? x * (1.0 - x * (0.5 - x * (1.0 / 6.0))) : 1.0 - exp(-x);
}

// acos(CosAngle): where a Blinn-Phong lobe of this power has fallen to the threshold. Radians.
float specular_lobe_angle(float power) {
    return 2.0 * asin(sqrt(0.5 * one_minus_lobe_cosine(power)));
}

float light_area_angle(float source_radius, float light_distance) {
    return atan(source_radius / light_distance);
}

// The slide's LightSpecular with its CosAngle widened by a soft sphere light, not yet divided by
// the lobe's energy. 1 - cos is taken as 2 sin^2(x / 2): the slide's (Dot - 1) / (CosAngle - 1)
// to the letter, but exact in float for the sharp powers, whose cosine rounds to 1.
float gaussian_specular_lobe(vec3 n, vec3 h, float n_o_l, float lobe_angle) {
    vec3 difference = n - h;
    float one_minus_dot = min(0.5 * dot(difference, difference), 1.0);
    float sine = sin(0.5 * lobe_angle);
    float norm_angle = one_minus_dot / (2.0 * sine * sine);
    return exp(-norm_angle * norm_angle) * n_o_l;
}

// Normalized specular reflection of one light, times the cosine: multiply with the specular colour
// and the irradiance at normal incidence. [Mittring12 "Soft Sphere Area Light", "Energy
// conserving"]
float gaussian_specular(vec3 n, vec3 h, float n_o_l, float power, float area_angle) {
    float lobe_angle = specular_lobe_angle(power) + area_angle;
    return gaussian_specular_lobe(n, h, n_o_l, lobe_angle) / (lobe_angle * lobe_angle * 10.0);
}

// Half angle of the uniform cone that has the mean squared angle of the mirrored lobe. Radians.
// A Blinn-Phong lobe about the half vector is exp(-p h^2 / 2): <h^2> = 2 / p, and the mirrored ray
// turns by 2 h; a uniform cone of half angle a has a^2 / 2. [inferred; p + 2 = 2 / alpha^2 keeps
// the broad lobes finite]
float specular_cone_half_angle(float power) {
    return min(4.0 * inversesqrt(power + 2.0), 0.5 * PI);
}

// Reflectance at the angle whose cosine is v_o_h [Schlick94].
vec3 fresnel_schlick(vec3 specular_color, float v_o_h) {
    float x = 1.0 - clamp(v_o_h, 0.0, 1.0);
    float squared = x * x;
    return specular_color + (1.0 - specular_color) * (squared * squared * x);
}

// Share of a uniform environment that a GGX surface mirrors into the direction of cosine n_o_v,
// with height-correlated Smith shadowing: specular_color * (1 - loss - grazing) + grazing, the
// split of [Karis13 "Environment BRDF"]. loss and grazing are exponentials of cubics in roughness
// and sqrt(n_o_v), fitted by least squares to the integral over 33x33 directions and roughnesses:
// mean error 0.006 and 0.002, largest 0.05 and 0.03. [Karis14]'s shorter fit, made for another
// shadowing term, is 0.03 off in the mean and 0.15 at most.
vec3 environment_brdf(vec3 specular_color, float roughness, float n_o_v) {
    float r = roughness;
    float s = sqrt(n_o_v);
    float grazing = exp(0.051 + s * (-0.548 + s * (-1.160 - 8.007 * s))
        + r * (-1.677 + s * (3.414 + 7.621 * s) + r * (-6.422 - 8.690 * s + 5.962 * r)));
    float loss = exp(-2.922 + s * (-0.473 + s * (-11.660 + 3.549 * s))
        + r * (1.073 + s * (25.026 + 2.432 * s) + r * (-9.110 - 15.918 * s + 7.639 * r)));
    return specular_color * max(1.0 - loss - grazing, 0.0) + grazing;
}

// Share of all light from a hemisphere that such a surface mirrors: the mean of environment_brdf by
// cosine. loss and grazing are polynomials fitted to the integrals of the above: at most 0.007 and
// 0.004 off.
vec3 mirrored_share(vec3 specular_color, float roughness) {
    float r = roughness;
    float grazing = max(0.0482 + r * (0.0063 + r * (-0.1961 + 0.1479 * r)), 0.0);
    float loss = r * r * (-0.2676 + r * (2.1065 - 1.2503 * r));
    return specular_color * (1.0 - loss - grazing) + grazing;
}
