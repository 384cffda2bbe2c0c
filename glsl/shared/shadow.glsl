// Shadow maps: a tile of a layer of one texture array for each view.
//   directional: one view of the whole scene, and Light.cascade_count cascades along the camera's view
//   spot:        one view
//   point:       six views, +x -x +y -y +z -z
struct ShadowView {
    mat4 clip_from_world;
    float texel;       // width of a texel in m at a clip w of 1 (in a perspective view: per m of depth)
    float depth_bias;  // rounding of the stored depth, in its own units
    float layer;
    float scale;       // side of the tile, as a part of the layer's
    vec2 offset_uv;    // of the tile in its layer
    vec2 depth_range_m; // near and far plane
};

layout(std430) readonly buffer ShadowViews { ShadowView shadow_views[]; };
