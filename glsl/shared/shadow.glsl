// Shadow maps: each light owns consecutive views, starting at Light.shadow_view.
//   directional: one view of the whole scene, then Light.cascade_count cascades along the camera's view
//   spot:        one view
//   point:       six views, +x -x +y -y +z -z
const uint SHADOW_POINT_FACES = 6u;

const uint SHADOW_MAP_CASCADE = 0u;
const uint SHADOW_MAP_SCENE = 1u;
const uint SHADOW_MAP_LOCAL = 2u;

struct ShadowView {
    mat4 clip_from_world;
    float texel;      // width of a texel in m, for a clip w of 1 (so: per m of depth in a perspective view)
    float depth_bias; // in units of the stored depth: quantization
    uint map;         // SHADOW_MAP_*
    uint layer;
};

layout(std430) readonly buffer ShadowViews { ShadowView shadow_views[]; };
