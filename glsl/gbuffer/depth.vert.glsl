// Where a mesh is, for its depth alone: to the bit what gbuffer.vert finds.
#include "shared/view.glsl"
#include "lib/instance.glsl"

in vec3 a_position;
in uint a_instance;

invariant gl_Position;

void main() {
    mat4 world_from_local = instance_world_from_local(a_instance);
    vec4 position_ws = world_from_local * vec4(a_position, 1.0);
    gl_Position = u_view.clip_from_world * position_ws;
}
