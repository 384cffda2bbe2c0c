// The directions of the diffuse cones: nine groups that serve every surface normal.
// [Mittring12 "Diffuse Sampling 2/2": 9 well distributed cones in world space]
//
// A cone wide enough to be one of nine sees the walls of the room that it crosses, so each can be
// traced as CONE_SPLIT narrower ones beside each other. The weights max(0, n . d)^p, normalized,
// give the cosine-weighted mean of any environment of spherical harmonics order 2; the sets
// have the smallest error of that over all normals that tools/cone_directions.py found:
//
//   cones  p    rms    worst
//       9  1.3  6.6 %  11.1 %
//      36  1.1  0.7 %  1.3 %
//      63  1.0  0.7 %  1.1 %

#ifndef CONE_SPLIT
#define CONE_SPLIT 4
#endif

const int CONE_COUNT = 9;
#if CONE_SPLIT == 1
const float CONE_WEIGHT_POWER = 1.3;
// Radians: so many cones have the sphere's solid angle.
const float CONE_HALF_ANGLE = 0.6797;
const vec3 CONE_DIRECTIONS[9] = vec3[9](
    vec3(-0.9741, -0.1594, -0.1603),
    vec3(-0.4207, -0.4503, 0.7876),
    vec3(-0.2355, 0.6671, 0.7067),
    vec3(0.6682, 0.7332, -0.1261),
    vec3(-0.0634, -0.9871, -0.1472),
    vec3(-0.0704, -0.0933, -0.9931),
    vec3(0.6752, -0.1606, 0.7199),
    vec3(-0.4305, 0.8076, -0.4031),
    vec3(0.8512, -0.3573, -0.3845));
#elif CONE_SPLIT == 4
const float CONE_WEIGHT_POWER = 1.1;
// Radians: so many cones have the sphere's solid angle.
const float CONE_HALF_ANGLE = 0.3349;
const vec3 CONE_DIRECTIONS[36] = vec3[36](
    vec3(-0.9358, -0.2533, -0.2453),
    vec3(-0.9400, -0.0333, 0.3395),
    vec3(-0.9121, 0.3722, -0.1720),
    vec3(-0.7109, 0.1284, -0.6915),
    vec3(-0.5732, -0.3124, 0.7575),
    vec3(-0.2135, -0.7733, 0.5970),
    vec3(-0.0475, -0.1389, 0.9892),
    vec3(-0.7305, -0.6261, 0.2727),
    vec3(-0.2214, 0.7929, 0.5677),
    vec3(0.1065, 0.4409, 0.8912),
    vec3(-0.5099, 0.2732, 0.8157),
    vec3(-0.7549, 0.5522, 0.3538),
    vec3(0.7320, 0.6811, -0.0168),
    vec3(0.5559, 0.6120, -0.5625),
    vec3(0.2347, 0.9413, 0.2425),
    vec3(0.5904, 0.5761, 0.5652),
    vec3(-0.1175, -0.9909, 0.0658),
    vec3(-0.0528, -0.8502, -0.5239),
    vec3(-0.5928, -0.7621, -0.2604),
    vec3(0.4341, -0.8607, 0.2662),
    vec3(-0.1912, 0.0546, -0.9800),
    vec3(0.1468, -0.4417, -0.8851),
    vec3(0.4409, 0.1303, -0.8881),
    vec3(-0.4988, -0.4359, -0.7491),
    vec3(0.5685, 0.0283, 0.8222),
    vec3(0.7906, -0.3950, 0.4678),
    vec3(0.2935, -0.5579, 0.7763),
    vec3(0.9517, 0.1603, 0.2619),
    vec3(-0.5110, 0.6749, -0.5322),
    vec3(-0.4167, 0.9090, -0.0045),
    vec3(0.1007, 0.9397, -0.3269),
    vec3(-0.0135, 0.5808, -0.8140),
    vec3(0.6860, -0.3475, -0.6392),
    vec3(0.9077, -0.4106, -0.0869),
    vec3(0.9186, 0.1587, -0.3619),
    vec3(0.4854, -0.8167, -0.3120));
#elif CONE_SPLIT == 7
const float CONE_WEIGHT_POWER = 1.0;
// Radians: so many cones have the sphere's solid angle.
const float CONE_HALF_ANGLE = 0.2526;
const vec3 CONE_DIRECTIONS[63] = vec3[63](
    vec3(-0.9563, -0.2796, -0.0855),
    vec3(-0.8971, 0.0236, -0.4413),
    vec3(-0.9772, 0.2089, -0.0375),
    vec3(-0.7574, -0.4042, -0.5128),
    vec3(-0.9305, -0.0904, 0.3549),
    vec3(-0.7989, -0.5351, 0.2748),
    vec3(-0.7041, -0.6983, -0.1290),
    vec3(-0.2725, -0.5316, 0.8020),
    vec3(-0.6669, -0.3193, 0.6732),
    vec3(-0.3452, -0.0780, 0.9353),
    vec3(-0.4703, -0.7525, 0.4611),
    vec3(0.1020, -0.2674, 0.9582),
    vec3(0.1486, -0.6751, 0.7226),
    vec3(-0.6734, 0.1577, 0.7223),
    vec3(-0.1318, 0.8000, 0.5853),
    vec3(-0.3309, 0.4405, 0.8345),
    vec3(-0.5584, 0.6660, 0.4946),
    vec3(0.1798, 0.5651, 0.8052),
    vec3(0.0228, 0.1919, 0.9812),
    vec3(0.0516, 0.9736, 0.2224),
    vec3(-0.8536, 0.3631, 0.3736),
    vec3(0.6808, 0.6529, -0.3319),
    vec3(0.7131, 0.6850, 0.1492),
    vec3(0.3894, 0.9178, -0.0777),
    vec3(0.9419, 0.3197, -0.1029),
    vec3(0.2814, 0.7983, -0.5325),
    vec3(0.3971, 0.7984, 0.4525),
    vec3(0.7981, 0.2577, -0.5446),
    vec3(-0.0892, -0.9443, -0.3167),
    vec3(0.1788, -0.9833, 0.0331),
    vec3(-0.3631, -0.9308, 0.0428),
    vec3(0.3467, -0.8285, -0.4397),
    vec3(-0.0534, -0.9121, 0.4065),
    vec3(-0.4448, -0.7439, -0.4987),
    vec3(-0.0301, -0.6953, -0.7181),
    vec3(0.0212, -0.2894, -0.9570),
    vec3(-0.2135, 0.0912, -0.9727),
    vec3(0.3103, 0.0567, -0.9489),
    vec3(-0.4054, -0.3889, -0.8273),
    vec3(0.0367, 0.4539, -0.8903),
    vec3(-0.6211, 0.0180, -0.7835),
    vec3(0.4702, 0.4479, -0.7605),
    vec3(0.7936, -0.0551, 0.6060),
    vec3(0.5134, -0.4020, 0.7582),
    vec3(0.4503, 0.0662, 0.8904),
    vec3(0.7784, -0.4878, 0.3951),
    vec3(0.5951, 0.4385, 0.6735),
    vec3(0.8749, 0.3266, 0.3575),
    vec3(0.4477, -0.7998, 0.3998),
    vec3(-0.4984, 0.8014, -0.3307),
    vec3(-0.1615, 0.7583, -0.6316),
    vec3(-0.0649, 0.9718, -0.2267),
    vec3(-0.7790, 0.4553, -0.4311),
    vec3(-0.4670, 0.4518, -0.7601),
    vec3(-0.3970, 0.9081, 0.1334),
    vec3(-0.7656, 0.6431, 0.0160),
    vec3(0.7120, -0.5278, -0.4632),
    vec3(0.9385, -0.1178, -0.3245),
    vec3(0.8790, -0.4753, -0.0389),
    vec3(0.6641, -0.1242, -0.7373),
    vec3(0.5901, -0.8062, -0.0431),
    vec3(0.3880, -0.4829, -0.7850),
    vec3(0.9827, -0.0819, 0.1660));
#endif

// Cones below, a tenth of those above the surface, bring a two-hundredth of its light.
const float LEAST_COSINE = 0.1;

float cone_weight(vec3 normal, vec3 direction) {
    float cosine = dot(normal, direction);
    return cosine > LEAST_COSINE ? pow(cosine, CONE_WEIGHT_POWER) : 0.0;
}

// What a group's weighted sum is divided by.
float cone_group_weight(vec3 normal, int cone) {
    float sum = 0.0;
    for (int i = 0; i < CONE_SPLIT; ++i) sum += cone_weight(normal, CONE_DIRECTIONS[cone * CONE_SPLIT + i]);
    return sum;
}
