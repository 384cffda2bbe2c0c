// Light from emissive parallelograms and balls: irradiance in closed form, and where on them to look.
// [Lambert 1760], [Baum89 "Improving radiosity solutions through the use of analytically determined
// form-factors"]

#include "lib/color.glsl"
#include "lib/math.glsl"
#include "shared/area_light.glsl"


// Part of the vector irradiance along the normal that the edge between two directions, both above
// the horizon, brings: their angle times the normal's share of the plane through them.
float edge_irradiance(vec3 a, vec3 b, vec3 normal) {
    vec3 across = cross(a, b);
    float sine = length(across);
    return sine > 0.0 ? dot(across, normal) * (atan(sine, dot(a, b)) / sine) : 0.0;
}

// Unit normal of a face's front.
vec3 front_of_face(AreaLight face) { return cross(face.edge_u_ws, face.edge_v_ws) / face.area_m2; }

// Signed distance of p from the plane of a face; its front is positive.
float height_over_face(AreaLight face, vec3 p_ws) { return dot(p_ws - face.corner_ws, front_of_face(face)); }

// Distance from a light: from its plane or from its surface.
float height_over_light(AreaLight light, vec3 p_ws) {
    if (light.ball_radius > 0.0) return distance(p_ws, light.corner_ws) - light.ball_radius;
    return abs(height_over_face(light, p_ws));
}

// What a light shows to a point: a parallelogram itself, of a ball the disc inside of it whose rim the point
// sees, as a square of that area. Lambert's sum makes of it 1 % less than the disc's at 45 degrees, less
// than that farther off. [inferred]
AreaLight seen_from(AreaLight light, vec3 p_ws) {
    float r = light.ball_radius;
    if (r == 0.0) return light;
    const float outside = 1.001;
    vec3 to_p = p_ws - light.corner_ws;
    float here = length(to_p);
    float d = max(here, outside * r);  // from within it looks away
    vec3 n = to_p / max(here, 1e-3 * r);
    // A basis without poles but one. [Duff17 "Building an Orthonormal Basis, Revisited"]
    float side = n.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (side + n.z);
    float b = n.x * n.y * a;
    float half_side = 0.5 * sqrt(PI) * r * sqrt(1.0 - r * r / (d * d));
    light.edge_u_ws = vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x) * (2.0 * half_side);
    light.edge_v_ws = vec3(b, side + n.y * n.y * a, -n.y) * (2.0 * half_side);
    light.corner_ws += n * (r * r / d) - 0.5 * (light.edge_u_ws + light.edge_v_ws);
    light.area_m2 = 4.0 * half_side * half_side;
    return light;
}

// Integral of the cosine over the part of the face above the horizon, sr: irradiance by its radiance.
// Edges are clipped to the horizon; where the outline dips below, it is closed along it.
float face_irradiance(AreaLight face, vec3 p_ws, vec3 normal) {
    float height = height_over_face(face, p_ws);
    if (face.both_sides != 0.0) height = abs(height);
    if (height < LEAST_HEIGHT * sqrt(face.area_m2)) return 0.0;
    vec3 first = face.corner_ws - p_ws;
    vec3 corners[4] = vec3[4](first, first + face.edge_u_ws, first + face.edge_u_ws + face.edge_v_ws,
                              first + face.edge_v_ws);
    float sum = 0.0;
    vec3 leaves = vec3(0.0);
    vec3 enters = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec3 a = corners[i];
        vec3 b = corners[(i + 1) & 3];
        float above_a = dot(a, normal);
        float above_b = dot(b, normal);
        if (max(above_a, above_b) <= 0.0) continue;
        vec3 crossing = mix(a, b, clamp(above_a / (above_a - above_b), 0.0, 1.0));
        if (above_a < 0.0) {
            a = crossing;
            enters = crossing;
        }
        if (above_b < 0.0) {
            b = crossing;
            leaves = crossing;
        }
        sum += edge_irradiance(a, b, normal);
    }
    if (leaves != enters) sum += edge_irradiance(leaves, enters, normal);
    return 0.5 * abs(sum);
}

// Light of all faces without shadow.
vec3 area_irradiance(vec3 p_ws, vec3 normal) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < u_area_lights.count; ++i) {
        AreaLight face = seen_from(u_area_lights.faces[i], p_ws);
        sum += face.radiance * face_irradiance(face, p_ws, normal);
    }
    return sum;
}

// The faces' light is looked at in so many parts, one a pixel: see interleave.glsl.
const int AREA_STRATA = 9;

struct AreaSample {
    int face;           // -1: no light arrives
    vec3 point_ws;      // the middle of the part
    float radius;       // of a disc as large as the part, m
    int part;           // of the face's nine in which that point is
    vec3 irradiance;    // of the part without shadow, times AREA_STRATA
};

// How many of a face's nine parts lie along each edge.
ivec2 parts_along(AreaLight face) {
    float u = length(face.edge_u_ws);
    float v = length(face.edge_v_ws);
    return u > LONG_FACE * v ? ivec2(9, 1) : v > LONG_FACE * u ? ivec2(1, 9) : ivec2(3);
}

// A ninth of a face.
AreaLight part_of_face(AreaLight face, int part) {
    ivec2 count = parts_along(face);
    face.edge_u_ws /= float(count.x);
    face.edge_v_ws /= float(count.y);
    face.corner_ws += float(part % count.x) * face.edge_u_ws + float(part / count.x) * face.edge_v_ws;
    face.area_m2 /= 9.0;
    return face;
}

// One of the nine parts of a light's face by itself.
AreaSample sample_part(int light, vec3 p_ws, vec3 normal, int stratum) {
    AreaLight part = part_of_face(seen_from(u_area_lights.faces[light], p_ws), stratum);
    AreaSample s;
    s.face = light;
    s.point_ws = part.corner_ws + 0.5 * (part.edge_u_ws + part.edge_v_ws);
    s.radius = sqrt(part.area_m2 * INVERSE_PI);
    s.part = stratum;
    s.irradiance = part.radiance * (face_irradiance(part, p_ws, normal) * float(AREA_STRATA));
    return s;
}

// Of the lights without shadow maps: a lone face is cut into 3x3. Of several, each gets as many of the parts as
// its share of the light, at points of a lattice of rank one.
AreaSample sample_area_lights(vec3 p_ws, vec3 normal, int stratum) {
    float from_face[AREA_LIGHTS_MAX];
    float total = 0.0;
    int strongest = 0;
    for (int i = 0; i < u_area_lights.count; ++i) {
        AreaLight face = seen_from(u_area_lights.faces[i], p_ws);
        from_face[i] = face.shadow_view >= 0 ? 0.0 : luminance(face.radiance) * face_irradiance(face, p_ws, normal);
        total += from_face[i];
        if (from_face[i] > from_face[strongest]) strongest = i;
    }
    if (total <= 0.0) return AreaSample(-1, vec3(0.0), 0.0, 0, vec3(0.0));
    if (from_face[strongest] > 0.999 * total) return sample_part(strongest, p_ws, normal, stratum);
    AreaSample s;
    float left = (float(stratum) + 0.5) / float(AREA_STRATA) * total;
    int chosen = 0;
    while (chosen < u_area_lights.count - 1 && left > from_face[chosen]) left -= from_face[chosen++];
    AreaLight face = seen_from(u_area_lights.faces[chosen], p_ws);
    float along = clamp(left / from_face[chosen], 0.0, 1.0);
    float across = (float((stratum * 5) % AREA_STRATA) + 0.5) / float(AREA_STRATA);
    float parts = max(from_face[chosen] / total * float(AREA_STRATA), 1.0);
    s.face = chosen;
    s.point_ws = face.corner_ws + along * face.edge_u_ws + across * face.edge_v_ws;
    s.radius = sqrt(face.area_m2 * INVERSE_PI / parts);
    s.part = min(int(along * 3.0), 2) + 3 * min(int(across * 3.0), 2);
    s.irradiance = face.radiance * (total / luminance(face.radiance));
    return s;
}

// Light of all faces without shadow in a broad lobe around a direction, as the lobe's mean radiance. Each
// face is taken at four points; the lobe is a Gaussian with the mean squared angle of the cone, widened
// by the angle of what a point stands for, so that it stays normalized. Low light is shadowed after [Schlick94].
vec3 area_lobe_radiance(vec3 p_ws, vec3 normal, vec3 direction, float half_angle) {
    vec3 sum = vec3(0.0);
    float shadowing = half_angle * half_angle / 16.0;  // half of GGX's alpha: see specular_cone_half_angle
    for (int i = 0; i < u_area_lights.count; ++i) {
        AreaLight face = seen_from(u_area_lights.faces[i], p_ws);
        vec3 front = front_of_face(face);
        float part_m2 = 0.25 * face.area_m2;
        for (int k = 0; k < 4; ++k) {
            vec2 at = vec2(k & 1, k >> 1) * 0.5 + 0.25;
            vec3 path = face.corner_ws + at.x * face.edge_u_ws + at.y * face.edge_v_ws - p_ws;
            float squared = max(dot(path, path), 1e-12);
            vec3 to_light = path * inversesqrt(squared);
            float facing = -dot(front, to_light);
            if (face.both_sides != 0.0) facing = abs(facing);
            float n_o_l = dot(normal, to_light);
            if (min(facing, n_o_l) <= 0.0) continue;
            float solid_angle = min(part_m2 * facing / squared, 2.0 * PI);
            float variance = 0.25 * half_angle * half_angle + 0.25 * INVERSE_PI * solid_angle;
            float off_axis = 2.0 * (1.0 - dot(to_light, direction));  // squared angle
            float lit = n_o_l / mix(n_o_l, 1.0, shadowing);
            sum += face.radiance * (lit * solid_angle * exp(-0.5 * off_axis / variance) / (2.0 * PI * variance));
        }
    }
    return sum;
}

// What a cone meets of faces at one distance.
struct AreaHit {
    float distance_m;   // of the nearest
    float share;        // of the cone's width that they cover
    vec3 radiance;      // mean over what is covered
};

// Share of the interval x +- reach that lies in 0..1.
float covered_share(float x, float reach) {
    return max(min(x + reach, 1.0) - max(x - reach, 0.0), 0.0) / (2.0 * reach);
}

// Distance along a ray to a ball and the share of the cone that it covers, by the overlap of two discs.
vec2 meet_ball(AreaLight ball, vec3 origin, vec3 direction, float half_angle) {
    float r = ball.ball_radius;
    vec3 path = ball.corner_ws - origin;
    float t = dot(path, direction);
    if (t <= 0.0 || dot(path, path) <= r * r) return vec2(0.0);
    float off_axis = length(path - t * direction);
    float reach = max(t * tan(half_angle), 1e-6);
    float smaller = min(r, reach);
    float share = smoothstep(0.0, 2.0 * smaller, r + reach - off_axis) * (smaller * smaller / (reach * reach));
    return vec2(t - sqrt(max(r * r - off_axis * off_axis, 0.0)), share);
}

// Distance along a ray to a face and the share of the cone that it covers; share 0: not met.
vec2 meet_face(AreaLight face, vec3 origin, vec3 direction, float half_angle) {
    if (face.ball_radius > 0.0) return meet_ball(face, origin, direction, half_angle);
    vec3 front = front_of_face(face);
    float approach = -dot(front, direction);
    if (abs(approach) < 1e-4 || (approach < 0.0 && face.both_sides == 0.0)) return vec2(0.0);
    float t = dot(origin - face.corner_ws, front) / approach;
    if (t <= 0.0) return vec2(0.0);
    vec3 at = origin + t * direction - face.corner_ws;
    vec2 place = vec2(dot(cross(at, face.edge_v_ws), front), dot(cross(face.edge_u_ws, at), front)) / face.area_m2;
    vec2 reach = max(t * tan(half_angle), 1e-6) / vec2(length(face.edge_u_ws), length(face.edge_v_ws));
    return vec2(t, covered_share(place.x, reach.x) * covered_share(place.y, reach.y));
}

// The nearest face beyond `from_m` together with those up to `depth_m` behind it: tiles of one panel
// add up.
AreaHit hit_area_lights(vec3 origin, vec3 direction, float half_angle, float from_m, float depth_m) {
    AreaHit hit = AreaHit(0.0, 0.0, vec3(0.0));
    float nearest = 1e30;
    for (int i = 0; i < u_area_lights.count; ++i) {
        vec2 met = meet_face(u_area_lights.faces[i], origin, direction, half_angle);
        if (met.y > 0.0 && met.x > from_m) nearest = min(nearest, met.x);
    }
    if (nearest == 1e30) return hit;
    for (int i = 0; i < u_area_lights.count; ++i) {
        vec2 met = meet_face(u_area_lights.faces[i], origin, direction, half_angle);
        // Not "< nearest": computed twice, the nearest may come out nearer than itself.
        if (met.y <= 0.0 || met.x <= from_m || met.x > nearest + depth_m) continue;
        hit.share += met.y;
        hit.radiance += met.y * u_area_lights.faces[i].radiance;
    }
    return AreaHit(nearest, min(hit.share, 1.0), hit.radiance / max(hit.share, 1e-6));
}
