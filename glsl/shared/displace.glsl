// Meshes that a material displaces, into vertices of their own.

// Vertices in a row of one instance; DEFORM_GROUP at most.
struct DisplaceGroup {
    uint source;    // first vertex at rest
    uint target;    // first vertex written
    uint vertices;
    uint instance;
};

layout(std140) uniform Displace {
    uint groups;       // that are to be done
    float farthest_m;  // how far a vertex may move
} u_displace;
