// Emissive parallelograms: points are corner + s edge_u + t edge_v with s, t in 0..1. And balls.
const int AREA_LIGHTS_MAX = 16;
const int AREA_POINTS = 9;  // that a light's shadow maps look from
// Of a face's edges: from here on its nine parts lie in one row along the longer.
const float LONG_FACE = 3.0;
const int NO_VIEW = -1;
// Half the side of the cube in a ball whose corners are eight of its points, by its radius: so they spread
// about its middle as its disc does, by a quarter of the squared radius along each axis.
const float BALL_SPREAD = 0.53;
// Of a light's size: what is so near its plane is the light itself, by rounding: it gets no light and casts
// no shadow.
const float LEAST_HEIGHT = 1e-3;

struct AreaLight {
    vec3 corner_ws;     // of a ball its centre
    float both_sides;   // 1: the back emits too
    vec3 edge_u_ws;     // m; cross(edge_u, edge_v) points to the front
    float area_m2;
    vec3 edge_v_ws;
    float ball_radius;  // m; 0: a parallelogram
    vec3 radiance;      // W/(m^2 sr)
    int shadow_view;    // of its first point's first map in ShadowViews, or NO_VIEW
};

layout(std140) uniform AreaLights {
    int count;
    float inverse_radiance;  // of the brightest face: keeps irradiance within a half float
    AreaLight faces[AREA_LIGHTS_MAX];
} u_area_lights;
