// Values on the six sides of a cube, weighted by direction. [McTaggart04]

// Sides in the order of the brick's stacks: +x -x +y -y +z -z, named by their outward normal.
// A ray that travels along -x looks at the +x side.

// Which three sides a ray along `direction` sees.
uvec3 sides_seen(vec3 direction) {
    return uvec3(0u, 2u, 4u) + uvec3(greaterThan(direction, vec3(0.0)));
}

const float COVER_NOISE = 0.003;  // a code: what is below it has no colour of its own
const float FEW_CODES = 0.03;     // covers of which ratios say little
// A layer whose normal lies between the axes covers this share of what it hides at least.
const float LEAST_COVER = 0.5;

// What hides, where fronts cover so much of what is opaque: the rest are backs. As much of these as
// `own` belongs to the surface that the ray leaves, and lets it pass.
float hidden_share(float cover, float opacity, float own) {
    return max(min(cover, opacity), opacity - own);
}

// Opacity along an axis from which on a layer counts as partly whole, and from which on as whole.
const vec2 WHOLE_LAYER = vec2(0.3, 0.9);
// A whole layer hides as much at any angle down to this cosine.
const float LEAST_AHEAD = 0.2;

// Opacity along a unit direction, for a voxel of the way, from those along the axes. Projected areas add
// by the cosines, and no more is hidden than along the fullest axis. What covers a part of the voxel, as
// bars or an edge beside the ray do, covers less of a ray that passes at an angle; a whole layer does not:
// it is crossed on a longer way, by one over the cosine, and what counts is what it hides there.
float opacity_along(vec3 cosines, vec3 opaque) {
    vec3 met = cosines * opaque;
    vec2 ahead = met.x >= max(met.y, met.z) ? vec2(cosines.x, opaque.x)
                 : met.y >= met.z ? vec2(cosines.y, opaque.y) : vec2(cosines.z, opaque.z);
    float whole = smoothstep(WHOLE_LAYER.x, WHOLE_LAYER.y, ahead.y);
    float sum = (met.x + met.y + met.z) / mix(1.0, max(ahead.x, LEAST_AHEAD), whole);
    return min(sum, max(opaque.x, max(opaque.y, opaque.z)));
}

// What a ray sees of voxels at a point, for a voxel of the way.
struct Sight {
    vec4 value;   // premultiplied radiance, opacity
    float front;  // projected area of what faces the ray less that of what faces away, at least 0
    float axis;   // opacity along the axis along which it is the greatest
};
const Sight NO_SIGHT = Sight(vec4(0.0), 0.0, 0.0);

// What a ray along a unit direction sees of three sides. Of a side, a is what fronts of surfaces cover, rgb
// their radiance times that; opaque: opacities along the axes, of which what no front covers is backs.
//
// Areas add by the cosines, as projected ones do: radiance is the mean over the fronts that the ray sees,
// sides that are fuller counting more, since in those that a wall before it crosses edge-on stands what is
// behind the wall as well. Backs are dark.
Sight mean_of_sides(vec4 x, vec4 y, vec4 z, vec3 opaque, vec3 direction, float own) {
    vec3 cosines = abs(direction);
    vec3 covers = vec3(x.a, y.a, z.a) + COVER_NOISE;
    vec3 areas = cosines * covers;
    float area = areas.x + areas.y + areas.z;
    float cover = area * area / dot(areas, cosines);
    vec3 radiance = (areas.x * x.rgb + areas.y * y.rgb + areas.z * z.rgb) / dot(areas, covers);
    float opacity = opacity_along(cosines, opaque);
    float hides = hidden_share(cover, opacity, own);
    float whole = min((hides + FEW_CODES) / (cover + FEW_CODES), 1.0 / LEAST_COVER);
    float front = max(dot(cosines, 2.0 * vec3(x.a, y.a, z.a) - opaque), 0.0);
    return Sight(vec4(radiance * cover * whole, hides), front, max(opaque.x, max(opaque.y, opaque.z)));
}

// A short mean normal says that the voxel's surfaces face several ways.
float normal_certainty(float squared_length) { return min(squared_length * 4.0, 1.0); }

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

// Share of its surface's area that a voxel with this mean normal turns towards a ray along `direction`.
float front_area(vec3 mean_normal, vec3 direction) {
    float squared_length = dot(mean_normal, mean_normal);
    float cosine = -dot(mean_normal, direction) * inversesqrt(max(squared_length, 1e-6));
    return mix(1.0, max(cosine, 0.0), normal_certainty(squared_length));
}
