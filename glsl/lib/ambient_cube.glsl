// Values on the six sides of a cube, weighted by direction. [McTaggart04]

// Sides in the order of the brick's stacks: +x -x +y -y +z -z, named by their outward normal.
// A ray that travels along -x looks at the +x side.

// Which three sides a ray along `direction` sees.
uvec3 sides_seen(vec3 direction) {
    return uvec3(0u, 2u, 4u) + uvec3(greaterThan(direction, vec3(0.0)));
}

// Squared components of a unit vector sum to one.
vec3 side_weights(vec3 direction) { return direction * direction; }

// What a ray sees of three sides, by their weights. Radiance is averaged as its square root: where the
// side that a ray meets head-on is dark, what the sides beside it show is mostly of the other face of
// a wall, and counts little; where all show the same, it counts whole. [inferred: the plain mean lets
// twice to three times as much of a sunlit outer wall into a closed room]
vec4 mean_of_sides(vec4 x, vec4 y, vec4 z, vec3 weights) {
    vec3 root = weights.x * sqrt(x.rgb) + weights.y * sqrt(y.rgb) + weights.z * sqrt(z.rgb);
    return vec4(root * root, dot(weights, vec3(x.a, y.a, z.a)));
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

// Share of its radiance that a voxel with this mean normal shows to a ray along `direction`.
const float FRONT_SLOPE = 4.0;  // of the change from front to back, over the cosine

float front_visibility(vec3 mean_normal, vec3 direction) {
    float squared_length = dot(mean_normal, mean_normal);
    float cosine = -dot(mean_normal, direction) * inversesqrt(max(squared_length, 1e-6));
    return mix(1.0, clamp(0.5 + FRONT_SLOPE * cosine, 0.0, 1.0), normal_certainty(squared_length));
}
