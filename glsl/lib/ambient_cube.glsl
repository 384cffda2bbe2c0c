// Values on the six sides of a cube, weighted by direction. [McTaggart04]

// Sides in the order of the brick's stacks: +x -x +y -y +z -z, named by their outward normal.
// A ray that travels along -x looks at the +x side.

// Which three sides a ray along `direction` sees.
uvec3 sides_seen(vec3 direction) {
    return uvec3(0u, 2u, 4u) + uvec3(greaterThan(direction, vec3(0.0)));
}

// Squared components of a unit vector sum to one.
vec3 side_weights(vec3 direction) { return direction * direction; }

const float OPACITY_NOISE = 0.02;  // a few codes: below it, ratios of opacities say nothing

// What a ray along a unit direction sees of three sides: premultiplied radiance and opacity.
//
// Opacity is what the sides cover as seen along the ray: their areas add by the cosines, not by the
// squares, which lose it at low angles; no more is hidden than the fullest side hides.
//
// Radiance is averaged as its square root, by squared cosines: where the side that a ray meets head-on is
// dark, what the sides beside it show is mostly of the other face of a wall, and counts little; where all
// show the same, it counts whole. [inferred: the plain mean lets twice to three times as much of a sunlit
// outer wall into a closed room]
vec4 mean_of_sides(vec4 x, vec4 y, vec4 z, vec3 direction) {
    vec3 covers = vec3(x.a, y.a, z.a);
    float opacity = min(dot(abs(direction), covers), max(covers.x, max(covers.y, covers.z)));
    vec3 weights = side_weights(direction);
    vec3 noisy = covers + OPACITY_NOISE;
    vec3 root = weights.x * sqrt(x.rgb * noisy.x) + weights.y * sqrt(y.rgb * noisy.y)
              + weights.z * sqrt(z.rgb * noisy.z);
    root /= dot(weights, noisy);
    return vec4(root * root * (opacity + OPACITY_NOISE), opacity);
}

// A short mean normal says that the voxel's surfaces face several ways.
float normal_certainty(float squared_length) { return min(squared_length * 4.0, 1.0); }

// Share of a leaf's radiance that a side shows, from the squared length of its mean normal and the
// cosine between that and the side. A surface shows its radiance to all of the half space before it.
// A side seen edge-on (cosine 0) serves that half space and the one behind, and gets all of it: see
// mean_of_sides. sqrt(3) makes the three front sides of a diagonal normal show it whole, its three
// back sides nothing.
float side_visibility(float squared_length, float cosine) {
    float facing = clamp(1.0 + sqrt(3.0) * cosine, 0.0, 1.0);
    return mix(1.0, facing, normal_certainty(squared_length));
}

// How many voxels a layer with this mean normal has on the area of one: fewer where the lattice cuts it
// at an angle, by the largest component of its normal.
float voxels_an_area(vec3 mean_normal) {
    float squared_length = dot(mean_normal, mean_normal);
    vec3 size = abs(mean_normal) * inversesqrt(max(squared_length, 1e-6));
    return mix(1.0, max(max(size.x, max(size.y, size.z)), 0.5), normal_certainty(squared_length));
}

// Share of its radiance that a voxel with this mean normal shows to a ray along `direction`.
const float FRONT_SLOPE = 4.0;  // of the change from front to back, over the cosine

float front_visibility(vec3 mean_normal, vec3 direction) {
    float squared_length = dot(mean_normal, mean_normal);
    float cosine = -dot(mean_normal, direction) * inversesqrt(max(squared_length, 1e-6));
    return mix(1.0, clamp(0.5 + FRONT_SLOPE * cosine, 0.0, 1.0), normal_certainty(squared_length));
}
