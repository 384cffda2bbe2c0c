// Whether a world box can be seen: by the frustum, and by a pyramid of the farthest depths. Never
// wrong about what is seen. [Greene93 "Hierarchical Z-Buffer Visibility"]
#include "shared/view.glsl"

const int PYRAMID_LEVELS = 8;  // texels of 2 to 256 pixels
const int PYRAMID_SPAN = 4;    // texels that a box is looked up in, a side, where levels suffice

// Rounding of a sum of products, as a part of its terms' magnitudes: 2^-20 is 16 steps of float32.
const float ROUNDING = 9.6e-7;
// Parts of a pixel by which a rasterizer may move a vertex, and with it a slanted triangle's depth.
const float SNAP_PX = 1.0 / 16.0;

// Clip-space coordinate of a point and how far rounding may be off.
vec2 coordinate_cs(vec4 row, vec3 p_ws) {
    return vec2(dot(row.xyz, p_ws) + row.w, ROUNDING * (dot(abs(row.xyz), abs(p_ws)) + abs(row.w)));
}

// Whether the box is not wholly outside one of the frustum's planes.
bool is_in_frustum(vec3 low, vec3 high) {
    mat4 rows = transpose(u_view.clip_from_world);
    vec3 farthest = max(abs(low), abs(high));
    for (int axis = 0; axis < 3; ++axis) {
        vec4 magnitude = abs(rows[3]) + abs(rows[axis]);
        float rounding = ROUNDING * (dot(magnitude.xyz, farthest) + magnitude.w);
        for (float side = -1.0; side <= 1.0; side += 2.0) {
            vec4 plane = rows[3] + side * rows[axis];
            vec3 inner = mix(low, high, greaterThan(plane.xyz, vec3(0.0)));
            if (dot(plane.xyz, inner) + plane.w < -rounding) return false;
        }
    }
    return true;
}

// What a box may cover of the picture: pixels `from` to `to`, and nothing nearer than `nearest` in
// the depth buffer's values.
struct Footprint {
    ivec2 from;
    ivec2 to;
    float nearest;
};

// false where the eye's or the near plane cuts the box.
bool find_footprint(vec3 low, vec3 high, out Footprint footprint) {
    mat4 rows = transpose(u_view.clip_from_world);
    vec3 first = vec3(1e9), last = vec3(-1e9), slack = vec3(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        vec3 p_ws = mix(low, high, bvec3(corner & 1, corner & 2, corner & 4));
        vec2 w = coordinate_cs(rows[3], p_ws);
        if (w.x <= 2.0 * w.y) return false;  // the eye's plane cuts it
        vec3 p, rounding;
        for (int axis = 0; axis < 3; ++axis) {
            vec2 c = coordinate_cs(rows[axis], p_ws);
            p[axis] = c.x / w.x;
            rounding[axis] = (c.y + abs(p[axis]) * w.y) / w.x + ROUNDING;
        }
        first = min(first, p);
        last = max(last, p);
        slack = max(slack, rounding);
    }
    if (first.z <= -1.0) return false;  // the near plane cuts it
    footprint.nearest = 0.5 * (first.z - slack.z - SNAP_PX * (last.z - first.z)) + 0.5;
    vec2 rim = u_view.viewport_px.xy - 1.0;
    vec2 low_px = ((first.xy - slack.xy) * 0.5 + 0.5) * u_view.viewport_px.xy - 1.0;
    vec2 high_px = ((last.xy + slack.xy) * 0.5 + 0.5) * u_view.viewport_px.xy + 1.0;
    footprint.from = ivec2(clamp(low_px, vec2(0.0), rim));
    footprint.to = ivec2(clamp(high_px, vec2(0.0), rim));
    return true;
}

// Whether every pixel of the footprint shows something nearer.
bool is_hidden(sampler2D pyramid, Footprint footprint) {
    ivec2 from = footprint.from, to = footprint.to;
    int level = 0;
    while (level < PYRAMID_LEVELS - 1
        && any(greaterThanEqual((to >> (level + 1)) - (from >> (level + 1)),
                                ivec2(PYRAMID_SPAN)))) {
        ++level;
    }
    from >>= level + 1;
    to >>= level + 1;
    for (int y = from.y; y <= to.y; ++y) {
        for (int x = from.x; x <= to.x; ++x) {
            if (texelFetch(pyramid, ivec2(x, y), level).r >= footprint.nearest) return false;
        }
    }
    return true;
}
