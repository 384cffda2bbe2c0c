// The directions of the diffuse cones: nine groups that serve every surface normal.
// [Mittring12 "Diffuse Sampling 2/2": 9 well distributed cones in world space]
//
// A cone wide enough to be one of nine sees the walls of the room that it crosses, so each can be
// traced as CONE_SPLIT narrower ones beside each other. The weights c (1 + s c), c = n . d,
// normalized, give the cosine-weighted mean of any environment of spherical harmonics order 2; the
// sets have small errors of that over all normals, and beside walls (tools/cone_directions.py):
//
//   cones  s     rms    worst
//       9  0.60  6.7 %  11.1 %
//      36  0.12  1.1 %  2.3 %
//      63  0.02  0.7 %  1.4 %

#ifndef CONE_SPLIT
#define CONE_SPLIT 4
#endif

const int CONE_COUNT = 9;
#if CONE_SPLIT == 1
const float CONE_WEIGHT_SLOPE = 0.60;
// Radians: so many cones have the sphere's solid angle.
const float CONE_HALF_ANGLE = 0.6797;
const vec3 CONE_DIRECTIONS[9] = vec3[9](
    vec3(-0.5913, 0.7525, 0.2899),
    vec3(0.8710, -0.0726, -0.4859),
    vec3(-0.0195, -0.7572, -0.6529),
    vec3(0.0356, 0.6447, -0.7636),
    vec3(0.6383, 0.7056, 0.3077),
    vec3(-0.8596, -0.0066, -0.5109),
    vec3(-0.0114, 0.0792, 0.9968),
    vec3(-0.6464, -0.6494, 0.4006),
    vec3(0.5833, -0.6963, 0.4184));
#elif CONE_SPLIT == 4
const float CONE_WEIGHT_SLOPE = 0.12;
// Radians: so many cones have the sphere's solid angle.
const float CONE_HALF_ANGLE = 0.3349;
const vec3 CONE_DIRECTIONS[36] = vec3[36](
    vec3(-0.4769, 0.8766, 0.0644),
    vec3(-0.6430, 0.4554, 0.6158),
    vec3(-0.9018, 0.4236, 0.0859),
    vec3(-0.1595, 0.7957, 0.5843),
    vec3(0.8962, -0.3077, -0.3195),
    vec3(0.8139, 0.3036, -0.4953),
    vec3(0.5442, -0.1260, -0.8295),
    vec3(0.9761, 0.2106, 0.0537),
    vec3(-0.0576, -0.5854, -0.8087),
    vec3(0.0370, -0.9511, -0.3066),
    vec3(0.4926, -0.6623, -0.5646),
    vec3(-0.5763, -0.6077, -0.5465),
    vec3(0.3137, 0.4937, -0.8111),
    vec3(-0.2806, 0.4736, -0.8348),
    vec3(-0.0958, 0.8974, -0.4308),
    vec3(-0.0048, -0.0406, -0.9992),
    vec3(0.6923, 0.6796, 0.2425),
    vec3(0.3845, 0.5682, 0.7276),
    vec3(0.1621, 0.9770, 0.1383),
    vec3(0.5155, 0.7936, -0.3231),
    vec3(-0.9355, 0.0061, -0.3532),
    vec3(-0.5829, -0.0684, -0.8097),
    vec3(-0.6841, 0.5737, -0.4504),
    vec3(0.7725, 0.1067, 0.6260),
    vec3(-0.1184, 0.2897, 0.9498),
    vec3(0.3210, -0.0886, 0.9429),
    vec3(-0.5100, -0.1264, 0.8508),
    vec3(-0.0722, -0.5350, 0.8417),
    vec3(-0.5700, -0.6432, 0.5112),
    vec3(-0.4437, -0.8961, -0.0126),
    vec3(-0.8792, -0.4751, -0.0351),
    vec3(-0.9131, -0.0892, 0.3979),
    vec3(0.4978, -0.5921, 0.6337),
    vec3(0.5580, -0.8293, 0.0304),
    vec3(0.8891, -0.3702, 0.2693),
    vec3(0.0394, -0.9303, 0.3648));
#elif CONE_SPLIT == 7
const float CONE_WEIGHT_SLOPE = 0.02;
// Radians: so many cones have the sphere's solid angle.
const float CONE_HALF_ANGLE = 0.2526;
const vec3 CONE_DIRECTIONS[63] = vec3[63](
    vec3(-0.6570, 0.6756, 0.3344),
    vec3(-0.3489, 0.9322, 0.0959),
    vec3(-0.2575, 0.7931, 0.5520),
    vec3(-0.6736, 0.7241, -0.1481),
    vec3(-0.9279, 0.3623, 0.0879),
    vec3(-0.8008, 0.2809, 0.5289),
    vec3(-0.4699, 0.4444, 0.7627),
    vec3(0.9353, -0.1057, -0.3377),
    vec3(0.6945, 0.1430, -0.7051),
    vec3(0.6679, -0.3383, -0.6629),
    vec3(0.8699, 0.3475, -0.3501),
    vec3(0.7962, -0.5430, -0.2668),
    vec3(0.9829, 0.1724, 0.0641),
    vec3(0.3689, -0.0904, -0.9250),
    vec3(-0.1726, -0.6486, -0.7413),
    vec3(0.0311, -0.8992, -0.4364),
    vec3(0.2693, -0.5467, -0.7928),
    vec3(-0.4780, -0.7665, -0.4291),
    vec3(0.4648, -0.7673, -0.4417),
    vec3(-0.0815, -0.2483, -0.9652),
    vec3(-0.2214, -0.9724, -0.0736),
    vec3(-0.1360, 0.5796, -0.8035),
    vec3(0.1689, 0.8068, -0.5662),
    vec3(0.3740, 0.4454, -0.8135),
    vec3(0.0277, 0.2057, -0.9782),
    vec3(-0.3485, 0.8241, -0.4465),
    vec3(0.5879, 0.6629, -0.4636),
    vec3(-0.0062, 0.9804, -0.1969),
    vec3(0.5232, 0.7702, 0.3647),
    vec3(0.7896, 0.6134, 0.0177),
    vec3(0.7874, 0.4108, 0.4596),
    vec3(0.4334, 0.8959, -0.0978),
    vec3(0.1825, 0.7295, 0.6592),
    vec3(0.4719, 0.4050, 0.7831),
    vec3(0.0997, 0.9608, 0.2587),
    vec3(-0.7767, 0.0044, -0.6299),
    vec3(-0.9802, -0.0335, -0.1951),
    vec3(-0.8505, 0.3780, -0.3658),
    vec3(-0.7895, -0.4368, -0.4312),
    vec3(-0.5126, -0.3498, -0.7841),
    vec3(-0.5597, 0.4798, -0.6757),
    vec3(-0.4127, 0.1104, -0.9042),
    vec3(0.1964, 0.0562, 0.9789),
    vec3(-0.3280, 0.0421, 0.9437),
    vec3(-0.0388, 0.4297, 0.9021),
    vec3(-0.0491, -0.3136, 0.9483),
    vec3(0.6012, -0.0396, 0.7981),
    vec3(-0.0186, -0.7126, 0.7013),
    vec3(0.8846, -0.0248, 0.4656),
    vec3(-0.7510, -0.4982, 0.4334),
    vec3(-0.4051, -0.8151, 0.4141),
    vec3(-0.6249, -0.7806, 0.0108),
    vec3(-0.4282, -0.4788, 0.7664),
    vec3(-0.8986, -0.4388, 0.0011),
    vec3(-0.6886, -0.1079, 0.7171),
    vec3(-0.9528, -0.0815, 0.2926),
    vec3(0.3972, -0.7835, 0.4779),
    vec3(0.7275, -0.4569, 0.5118),
    vec3(0.6703, -0.7330, 0.1162),
    vec3(0.3719, -0.4377, 0.8186),
    vec3(0.3082, -0.9503, -0.0447),
    vec3(0.9437, -0.3139, 0.1047),
    vec3(0.0172, -0.9536, 0.3006));
#endif

const float REJECTED = -1.0;  // alpha of a group, or of a cone, that lies behind the surface whole

// Cones below, a tenth of those above the surface, bring a two-hundredth of its light.
const float LEAST_COSINE = 0.1;

float cone_weight(vec3 normal, vec3 direction) {
    float cosine = dot(normal, direction);
    return cosine > LEAST_COSINE ? cosine * (1.0 + CONE_WEIGHT_SLOPE * cosine) : 0.0;
}

// What a group's weighted sum is divided by.
float cone_group_weight(vec3 normal, int cone) {
    float sum = 0.0;
    for (int i = 0; i < CONE_SPLIT; ++i)
        sum += cone_weight(normal, CONE_DIRECTIONS[cone * CONE_SPLIT + i]);
    return sum;
}
