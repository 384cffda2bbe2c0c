// What the draws of a view leave out: see cull/instances.comp.

const uint CULL_GROUP = 64u;  // instances that a group of threads decides on at once

layout(std140) uniform Culling {
    uint command_count;  // draw commands of solid surfaces; others follow them
} u_culling;

// World box of an instance. Hidden ones are not `visible`.
struct InstanceBox {
    vec3 low;
    float visible;  // 0 or 1
    vec3 high;
    float reserved0;
};

// What became of the instances that a view could draw.
struct CullCounts {
    uint drawn;
    uint outside;  // the frustum
    uint hidden;   // by what was drawn before
    uint triangles_drawn;
};
