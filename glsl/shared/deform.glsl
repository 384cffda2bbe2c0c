// Meshes that bend: morph targets, then a skin, once a frame, into vertices of their own.

const uint MORPH_FLOATS = 9u;       // a vertex and target: what is added to position, normal, tangent

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
