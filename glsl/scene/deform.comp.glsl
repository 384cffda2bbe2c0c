// Morphs and skins vertices, so that every pass behind draws plain triangles. Skinned ones come out
// in the world. [glTF 2.0, 3.7.2.2 "Morph Targets", 3.7.3 "Skins"]

#include "lib/dispatch.glsl"
#include "shared/deform.glsl"
#include "shared/vertex.glsl"

layout(local_size_x = 64) in;  // DEFORM_GROUP

layout(std430) readonly buffer Groups { DeformGroup groups[]; };
layout(std430) readonly buffer Influences { uvec2 influences[]; };  // joint, bits of its weight
layout(std430) readonly buffer Joints { mat4 joints[]; };
layout(std430) readonly buffer Morphs { float morphs[]; };
layout(std430) readonly buffer Weights { float weights[]; };
layout(std430) buffer Positions { float positions[]; };
layout(std430) buffer Surface { float surface[]; };

vec3 morph(uint at) {
    return vec3(morphs[at], morphs[at + 1u], morphs[at + 2u]);
}

vec3 unit(vec3 v) {
    return v * inversesqrt(max(dot(v, v), 1e-30));
}

// The inverse transpose but for a positive factor, of singular matrices too.
mat3 normal_matrix(mat3 m) {
    mat3 cofactors = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    return dot(m[0], cofactors[0]) < 0.0 ? -1.0 * cofactors : cofactors;
}

void main() {
    uint thread = linear_thread_id();
    uint number = thread / DEFORM_GROUP, vertex = thread % DEFORM_GROUP;
    if (number >= u_deform.groups || vertex >= groups[number].vertices) return;
    DeformGroup group = groups[number];

    uint at = (group.source + vertex) * POSITION_FLOATS;
    vec3 position = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
    at = (group.source + vertex) * SURFACE_FLOATS;
    vec3 normal = vec3(surface[at], surface[at + 1u], surface[at + 2u]);
    vec3 tangent = vec3(surface[at + 3u], surface[at + 4u], surface[at + 5u]);

    for (uint t = 0u; t < group.weights; ++t) {
        float weight = weights[group.first_weight + t];
        if (weight == 0.0) continue;
        at = (group.first_morph + t * group.target_stride + vertex) * MORPH_FLOATS;
        position += weight * morph(at);
        normal += weight * morph(at + 3u);
        tangent += weight * morph(at + 6u);
    }

    if (group.influences > 0u) {
        mat4 blend = mat4(0.0);
        for (uint k = 0u; k < group.influences; ++k) {
            uvec2 influence = influences[group.first_influence + vertex * group.influences + k];
            float weight = uintBitsToFloat(influence.y);
            if (weight > 0.0) blend += weight * joints[group.first_joint + influence.x];
        }
        position = (blend * vec4(position, 1.0)).xyz;
        normal = normal_matrix(mat3(blend)) * normal;
        tangent = mat3(blend) * tangent;
    }
    normal = unit(normal);
    tangent = unit(tangent);

    at = (group.target + vertex) * POSITION_FLOATS;
    positions[at] = position.x;
    positions[at + 1u] = position.y;
    positions[at + 2u] = position.z;
    at = (group.target + vertex) * SURFACE_FLOATS;
    surface[at] = normal.x;
    surface[at + 1u] = normal.y;
    surface[at + 2u] = normal.z;
    surface[at + 3u] = tangent.x;
    surface[at + 4u] = tangent.y;
    surface[at + 5u] = tangent.z;
}
