// Punctual lights, after the glTF extension KHR_lights_punctual.
const uint LIGHT_DIRECTIONAL = 0u;
const uint LIGHT_POINT = 1u;
const uint LIGHT_SPOT = 2u;

struct Light {
    vec3 position_ws;
    float range;          // m; 0 = unbounded
    vec3 direction_ws;    // unit, the way the light travels
    float source_radius;  // m; radians for a directional light
    vec3 intensity;       // colour times lux (directional) or candela, in scene units
    uint kind;
    float spot_scale;     // 1 / (cos inner - cos outer)
    float spot_offset;    // -cos outer * spot_scale
    int shadow_view;      // first entry in ShadowViews, or -1: casts no shadow
    uint first_cascade;   // of a directional light: entries in ShadowViews, the finest first
    uint cascade_count;
    int profile;          // layer of the light profiles, or -1: the same in all directions
    float penumbra_radius;  // source_radius, or 0: hard shadows
    int mask;             // layer of the light profiles that it shines through, or -1
    vec3 profile_axis_ws; // unit, across direction_ws: the profile's plane at 0 degrees, the mask's right
    float mask_scale;     // spot: 1 / tan of the outer angle; directional: 1 / width of the mask, m
    vec2 mask_offset;     // in masks
    vec2 reserved;
};

// Never empty: a scene without lights holds one of intensity 0.
layout(std430) readonly buffer Lights { Light lights[]; };
