// Meshes that bend: morph targets, then a skin, once a frame, into vertices of their own.

const uint DEFORM_GROUP = 64u;      // vertices, threads a group
const uint MORPH_FLOATS = 9u;       // a vertex and target: what is added to position, normal, tangent
const uint POSITION_FLOATS = 3u;    // a vertex in the scene's positions
const uint SURFACE_FLOATS = 12u;    // in the scene's surface: normal, tangent, then what stays

// Vertices in a row of one instance.
struct DeformGroup {
    uint source;           // first vertex at rest
    uint target;           // first vertex written
    uint vertices;
    uint influences;       // a vertex; 0: no skin
    uint first_influence;  // of the group's first vertex
    uint first_joint;      // of the instance
    uint first_morph;      // of the first target, for the group's first vertex
    uint target_stride;    // vertices from one target to the next
    uint first_weight;     // of the instance
    uint weights;          // morph targets; 0: none
};

layout(std140) uniform Deform {
    uint groups;  // that are to be done
} u_deform;
