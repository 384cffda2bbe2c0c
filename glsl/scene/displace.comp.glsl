// Moves the vertices of instances as their material says, so that every pass behind draws plain
// triangles. Normals follow from how the displacement differs nearby.

// Derivatives over pixels, which the artist's surface code may use, are not of this stage.
#define dFdx(x) (0.0 * (x))
#define dFdy(x) (0.0 * (x))
#define fwidth(x) (0.0 * (x))

#include "lib/dispatch.glsl"
#include "lib/material.glsl"
#include "shared/displace.glsl"
#include "shared/instances.glsl"
#include "shared/vertex.glsl"

layout(local_size_x = 64) in;  // DEFORM_GROUP

layout(std430) readonly buffer DisplaceGroups { DisplaceGroup groups[]; };
layout(std430) buffer Positions { float positions[]; };
layout(std430) buffer SurfaceVertices { float surface[]; };

// Distance to the points that a normal is found by, by the farthest displacement. [inferred: fine
// against waves of that height, coarse against rounding]
const float NORMAL_STEP = 0.02;

vec3 load_position(uint at) { return vec3(positions[at], positions[at + 1u], positions[at + 2u]); }
vec3 load_surface(uint at) { return vec3(surface[at], surface[at + 1u], surface[at + 2u]); }

void store_position(uint at, vec3 v) {
    positions[at] = v.x;
    positions[at + 1u] = v.y;
    positions[at + 2u] = v.z;
}

void store_surface(uint at, vec3 v) {
    surface[at] = v.x;
    surface[at + 1u] = v.y;
    surface[at + 2u] = v.z;
}

// 0 where there is no direction, as where a displacement leaves no area.
vec3 unit(vec3 v) {
    return v * inversesqrt(max(dot(v, v), 1e-30));
}

vec3 displaced(MaterialInput m, Parameters p, vec3 position_ws) {
    m.position_ws = position_ws;
    vec3 offset = displace(m, p);
    float length_m = length(offset);
    if (length_m == 0.0 || is_fault(length_m)) return position_ws;
    return position_ws + offset * min(1.0, u_displace.farthest_m / length_m);
}

void main() {
    uint thread = linear_thread_id();
    uint number = thread / DEFORM_GROUP, vertex = thread % DEFORM_GROUP;
    if (number >= u_displace.groups || vertex >= groups[number].vertices) return;
    DisplaceGroup group = groups[number];
    Instance instance = instances[group.instance];
    mat3 linear = mat3(instance.world_from_local);
    if (determinant(linear) == 0.0) return;  // hidden

    uint at = (group.source + vertex) * POSITION_FLOATS;
    vec3 position_ws = (instance.world_from_local * vec4(load_position(at), 1.0)).xyz;
    at = (group.source + vertex) * SURFACE_FLOATS;
    vec3 n = unit(mat3(instance.normal_from_local) * load_surface(at));
    vec3 t = linear * load_surface(at + 3u);
    t -= n * dot(n, t);
    if (dot(t, t) <= 1e-12)
        t = cross(n, abs(n.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0));
    t = normalize(t);
    vec3 b = cross(n, t);
    vec2 uv0 = vec2(surface[at + 7u], surface[at + 8u]);
    vec2 uv1 = vec2(surface[at + 9u], surface[at + 10u]);
    vec4 color = unpackUnorm4x8(floatBitsToUint(surface[at + 11u]));
    MaterialInput m = MaterialInput(instance.material, position_ws, n, uv0, uv1, color,
                                    u_material.time_s);
    Parameters p = material_parameters(instance.material);

    float step_m = NORMAL_STEP * u_displace.farthest_m;
    vec3 moved = displaced(m, p, position_ws);
    vec3 along_t = displaced(m, p, position_ws + t * step_m) - moved;
    vec3 along_b = displaced(m, p, position_ws + b * step_m) - moved;
    vec3 normal_ws = cross(along_t, along_b);
    normal_ws = dot(normal_ws, normal_ws) > 0.0 ? normalize(normal_ws) : n;

    mat3 local_from_world = inverse(linear);
    vec3 origin = instance.world_from_local[3].xyz;
    store_position((group.target + vertex) * POSITION_FLOATS, local_from_world * (moved - origin));
    at = (group.target + vertex) * SURFACE_FLOATS;
    store_surface(at, unit(transpose(linear) * normal_ws));
    store_surface(at + 3u, unit(local_from_world * along_t));
}
