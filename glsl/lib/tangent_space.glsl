// From a tangent-space normal to the world.
#include "lib/surface.glsl"

// bitangent = w * cross(normal, tangent), glTF 2.0 "Meshes". facing: -1 turns both the geometric
// normal and the map's bumps towards the viewer of a double-sided surface.
vec3 normal_from_tangent_space(vec3 normal_ts, vec3 normal_ws, vec4 tangent_ws, float facing) {
    vec3 n = normalize(normal_ws);
    vec3 t = tangent_ws.xyz - n * dot(n, tangent_ws.xyz);
    float squared = dot(t, t);
    if (!(squared >= 1e-12)) return n * facing;
    t *= inversesqrt(squared);
    vec3 b = cross(n, t) * tangent_ws.w;
    return normalize(t * normal_ts.x + b * normal_ts.y + n * normal_ts.z) * facing;
}

// Turns a unit normal as a height over its surface does, whose gradient in the world is known; only
// what of it lies in the surface counts. [Mikkelsen20 "Surface Gradient-Based Bump Mapping"]
vec3 bumped_normal(vec3 n, vec3 height_gradient) {
    return normalize(n - (height_gradient - n * dot(n, height_gradient)));
}

// A material's normal in the world: its map's, then its height's. facing as above.
vec3 surface_normal(Surface s, vec3 normal_ws, vec4 tangent_ws, float facing) {
    vec3 n = normal_from_tangent_space(s.normal_ts, normal_ws, tangent_ws, facing);
    // Most materials have none, which the compiler sees.
    return s.height_gradient == vec3(0.0) ? n : bumped_normal(n, s.height_gradient);
}
