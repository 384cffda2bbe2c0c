// Light that passes through a body of glass: where a ray leaves it, what is absorbed, how far it
// scatters. [KHR_materials_transmission], [KHR_materials_volume]; the shape behind the surface is
// not known to a forward pass, so it is taken from the curvature in front. [inferred]

// Reflectance at normal incidence between air and a dielectric.
float reflectance_of_ior(float ior) {
    float ratio = (ior - 1.0) / (ior + 1.0);
    return ratio * ratio;
}

// Absorption a metre of a body that lets `color` of the light through after `distance_m`.
vec3 absorption_of(vec3 color, float distance_m) {
    return distance_m > 0.0 ? -log(max(color, 1e-4)) / distance_m : vec3(0.0);
}

// The normal where a ray inside leaves, outwards. roundness 1: of a ball, whose normal turns about
// the chord as it did in front; 0: of a pane.
vec3 exit_normal(vec3 normal, vec3 inside, float roundness) {
    return normalize(mix(-normal, reflect(normal, inside), roundness));
}

struct RefractedRay {
    vec3 origin;      // where it leaves the body
    vec3 direction;   // unit
    float path_m;     // inside
};

// A ray that meets a body of this thickness (m, of a ball its diameter). Thin walls, of thickness
// 0, do not bend light.
RefractedRay refract_through(vec3 p_ws, vec3 direction, vec3 normal, float ior, float thickness_m,
                             float roundness) {
    if (thickness_m <= 0.0) return RefractedRay(p_ws, direction, 0.0);
    vec3 inside = refract(direction, normal, 1.0 / ior);
    // Of an ior below 1.
    if (inside == vec3(0.0)) return RefractedRay(p_ws, direction, thickness_m);
    float cosine = -dot(inside, normal);
    // A pane is as thick along its normal; through a ball the chord is 2 r cos.
    float path = thickness_m * mix(1.0 / max(cosine, 0.1), cosine, roundness);
    vec3 leaves = exit_normal(normal, inside, roundness);
    vec3 outside = refract(inside, -leaves, ior);
    if (outside == vec3(0.0)) outside = inside;  // would be reflected wholly
    return RefractedRay(p_ws + inside * path, outside, path);
}

// How round a body of this thickness is whose surface has the radius of curvature: 1 for a ball.
float roundness_of(float thickness_m, float radius_m) {
    return clamp(0.5 * thickness_m / max(radius_m, 1e-6), 0.0, 1.0);
}

// What a pane, two parallel faces, mirrors and lets through in all, light that goes to and fro
// between them included.
struct PaneShares {
    vec3 mirrored;
    vec3 passes;
};

// reflectance: of one face; kept: share of the light that is left after one way between them.
PaneShares pane_shares(vec3 reflectance, vec3 kept) {
    vec3 enters = 1.0 - reflectance;
    vec3 back = kept * reflectance;
    vec3 rounds = 1.0 / max(1.0 - back * back, 1e-3);
    return PaneShares(reflectance + enters * enters * kept * back * rounds,
                      enters * enters * kept * rounds);
}

// Half angle of the cone into which a rough surface scatters what passes, by the mirrored lobe's: a
// facet that turns by h turns a mirrored ray by 2 h, one that enters and leaves by (ior - 1) h at
// each of the two surfaces, independently. [inferred]
float refracted_half_angle(float mirrored_half_angle, float ior) {
    return mirrored_half_angle * 0.5 * abs(ior - 1.0) * 1.41421356;
}
