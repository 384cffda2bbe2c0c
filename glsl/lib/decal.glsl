// What a decal does to a surface, without its textures. [Mittring12 "GBuffer": decal mask]

// 1 on what faces the decal's z, 0 beyond the angle at which it ends: sides and backs stay clean.
float decal_fade(vec3 normal_ws, vec3 z_ws, float fade_end, float fade_scale) {
    return clamp((dot(normal_ws, z_ws) - fade_end) * fade_scale, 0.0, 1.0);
}

// How a point of the plane through p (relative to the eye), seen along ray, moves as the ray turns by
// ray_step. Near the plane's horizon the step is held within half and double the distance.
vec3 step_in_plane(vec3 p, vec3 normal, vec3 ray, vec3 ray_step) {
    float here = dot(normal, ray);
    float there = dot(normal, ray + ray_step);
    float ratio = there * here > 0.0 ? clamp(here / there, 0.5, 2.0) : 2.0;
    float along = dot(p, ray) / dot(ray, ray);
    return along * (ratio * (ray + ray_step) - ray);
}
