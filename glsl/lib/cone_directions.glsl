// The directions of the diffuse cones: nine groups that serve every surface normal.
// [Mittring12 "Diffuse Sampling 2/2": 9 well distributed cones in world space]
//
// A cone wide enough to be one of nine sees the walls of the room that it crosses, so each can be
// traced as CONE_SPLIT narrower ones beside each other. The weights max(0, n . d)^p, normalized,
// give the cosine-weighted mean of any environment of spherical harmonics order 2; the sets were
// chosen for the smallest error of that over all normals (tools/cone_directions.py):
//
//   cones  p    rms    worst
//       9  1.3  6.4 %  10.5 %
//      36  1.1  0.6 %  1.3 %
//      63  1.0  0.6 %  1.1 %

#ifndef CONE_SPLIT
#define CONE_SPLIT 4
#endif

const int CONE_COUNT = 9;
#if CONE_SPLIT == 1
const float CONE_WEIGHT_POWER = 1.3;
const float CONE_HALF_ANGLE = 0.6797;  // radians: so many cones have the sphere's solid angle
const vec3 CONE_DIRECTIONS[9] = vec3[9](
    vec3(0.8159, -0.4071, 0.4106),
    vec3(-0.1106, -0.9863, 0.1224),
    vec3(-0.4089, -0.4223, -0.8090),
    vec3(-0.9865, -0.1130, 0.1185),
    vec3(-0.2023, 0.6882, -0.6967),
    vec3(0.6958, 0.6958, 0.1781),
    vec3(-0.4028, 0.8158, 0.4150),
    vec3(0.6922, -0.1918, -0.6958),
    vec3(-0.1075, -0.1087, 0.9882));
#elif CONE_SPLIT == 4
const float CONE_WEIGHT_POWER = 1.1;
const float CONE_HALF_ANGLE = 0.3349;  // radians: so many cones have the sphere's solid angle
const vec3 CONE_DIRECTIONS[36] = vec3[36](
    vec3(0.8451, -0.5342, 0.0192),
    vec3(0.4383, -0.7997, 0.4103),
    vec3(0.7757, -0.2871, 0.5619),
    vec3(0.9955, 0.0487, 0.0812),
    vec3(-0.2039, -0.8073, 0.5538),
    vec3(-0.0142, -0.9988, 0.0463),
    vec3(-0.5791, -0.8100, -0.0921),
    vec3(0.4464, -0.8449, -0.2947),
    vec3(-0.6431, 0.1622, -0.7484),
    vec3(-0.1525, -0.1039, -0.9828),
    vec3(-0.5559, -0.4509, -0.6983),
    vec3(-0.1523, -0.8320, -0.5334),
    vec3(-0.7422, -0.5385, 0.3990),
    vec3(-0.9607, -0.0163, 0.2769),
    vec3(-0.9113, -0.3260, -0.2515),
    vec3(-0.9221, 0.2854, -0.2613),
    vec3(-0.1264, 0.5090, -0.8514),
    vec3(-0.5326, 0.7283, -0.4311),
    vec3(0.4445, 0.6139, -0.6523),
    vec3(0.0637, 0.9275, -0.3684),
    vec3(0.7172, 0.6892, -0.1032),
    vec3(0.2929, 0.9319, 0.2142),
    vec3(0.7755, 0.4466, 0.4463),
    vec3(0.2645, 0.6454, 0.7166),
    vec3(-0.3093, 0.6943, 0.6499),
    vec3(-0.7707, 0.5980, 0.2201),
    vec3(-0.3024, 0.9472, 0.1066),
    vec3(-0.6616, 0.2035, 0.7217),
    vec3(0.2451, -0.5206, -0.8179),
    vec3(0.7615, -0.3503, -0.5453),
    vec3(0.8628, 0.2138, -0.4580),
    vec3(0.4165, 0.0765, -0.9059),
    vec3(0.4881, 0.0977, 0.8673),
    vec3(-0.4087, -0.3230, 0.8536),
    vec3(0.2063, -0.4474, 0.8702),
    vec3(-0.0908, 0.1721, 0.9809));
#elif CONE_SPLIT == 7
const float CONE_WEIGHT_POWER = 1.0;
const float CONE_HALF_ANGLE = 0.2526;  // radians: so many cones have the sphere's solid angle
const vec3 CONE_DIRECTIONS[63] = vec3[63](
    vec3(0.9030, 0.1222, 0.4120),
    vec3(0.7232, -0.6501, 0.2330),
    vec3(0.7711, -0.3263, 0.5467),
    vec3(0.4032, -0.7391, 0.5396),
    vec3(0.6229, 0.0487, 0.7808),
    vec3(0.9582, -0.2635, 0.1115),
    vec3(0.7814, -0.5854, -0.2159),
    vec3(0.0246, -0.9715, -0.2356),
    vec3(0.4168, -0.9081, 0.0404),
    vec3(0.0485, -0.9554, 0.2914),
    vec3(-0.4414, -0.7718, 0.4577),
    vec3(-0.3246, -0.9445, 0.0505),
    vec3(-0.0396, -0.7340, 0.6780),
    vec3(-0.7193, -0.6922, 0.0594),
    vec3(-0.7905, -0.0647, -0.6090),
    vec3(-0.0988, -0.3789, -0.9202),
    vec3(-0.4537, -0.0799, -0.8875),
    vec3(-0.0464, 0.1023, -0.9937),
    vec3(-0.5113, -0.4982, -0.7003),
    vec3(-0.4902, -0.8001, -0.3457),
    vec3(-0.1234, -0.7776, -0.6165),
    vec3(-0.7262, -0.0399, 0.6863),
    vec3(-0.9466, 0.0843, 0.3112),
    vec3(-0.7842, -0.4264, 0.4508),
    vec3(-0.9561, -0.2879, 0.0549),
    vec3(-0.9745, 0.0647, -0.2149),
    vec3(-0.8228, -0.4451, -0.3535),
    vec3(-0.8929, 0.4503, -0.0015),
    vec3(-0.7677, 0.3880, -0.5100),
    vec3(0.4824, 0.6113, -0.6274),
    vec3(-0.4409, 0.3610, -0.8218),
    vec3(-0.3439, 0.7368, -0.5821),
    vec3(0.1188, 0.8603, -0.4957),
    vec3(-0.6416, 0.7283, -0.2405),
    vec3(0.0043, 0.5544, -0.8323),
    vec3(0.8258, 0.4005, -0.3970),
    vec3(0.6801, 0.5058, 0.5307),
    vec3(0.8156, 0.5694, 0.1024),
    vec3(0.4611, 0.8380, 0.2916),
    vec3(0.5853, 0.7807, -0.2189),
    vec3(0.2169, 0.9741, -0.0633),
    vec3(0.9829, 0.1812, -0.0342),
    vec3(-0.3248, 0.7284, 0.6033),
    vec3(-0.5278, 0.3499, 0.7740),
    vec3(-0.7577, 0.4909, 0.4299),
    vec3(0.1584, 0.7681, 0.6204),
    vec3(-0.2385, 0.9560, -0.1709),
    vec3(-0.0793, 0.9569, 0.2794),
    vec3(-0.5381, 0.8198, 0.1956),
    vec3(0.9266, -0.1405, -0.3489),
    vec3(0.2643, -0.6040, -0.7518),
    vec3(0.6631, -0.4027, -0.6310),
    vec3(0.3703, 0.2774, -0.8865),
    vec3(0.4266, -0.8100, -0.4023),
    vec3(0.7174, 0.0752, -0.6926),
    vec3(0.3483, -0.1792, -0.9201),
    vec3(0.1853, 0.0319, 0.9822),
    vec3(-0.4542, -0.4311, 0.7797),
    vec3(-0.0872, 0.4299, 0.8986),
    vec3(-0.3022, -0.0071, 0.9532),
    vec3(0.3659, 0.4305, 0.8251),
    vec3(-0.0197, -0.3749, 0.9269),
    vec3(0.4138, -0.3870, 0.8240));
#endif

float cone_weight(vec3 normal, vec3 direction) {
    return pow(max(dot(normal, direction), 0.0), CONE_WEIGHT_POWER);
}

// What a group's weighted sum is divided by.
float cone_group_weight(vec3 normal, int cone) {
    float sum = 0.0;
    for (int i = 0; i < CONE_SPLIT; ++i) sum += cone_weight(normal, CONE_DIRECTIONS[cone * CONE_SPLIT + i]);
    return sum;
}
