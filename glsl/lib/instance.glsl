// The buffer Instances as vertex shaders see it: drivers of GL 4.3 may have no storage blocks
// there.
#include "lib/texels.glsl"
#include "shared/instance.glsl"

uniform usamplerBuffer u_instances;

mat4 instance_world_from_local(uint instance) {
    return texel_matrix(u_instances, instance * INSTANCE_TEXELS);
}

mat4 instance_prev_world_from_local(uint instance) {
    return texel_matrix(u_instances, instance * INSTANCE_TEXELS + INSTANCE_PREV_TEXEL);
}

mat3 instance_normal_from_local(uint instance) {
    return mat3(texel_matrix(u_instances, instance * INSTANCE_TEXELS + INSTANCE_NORMAL_TEXEL));
}

uint instance_material(uint instance) {
    return texelFetch(u_instances, int(instance * INSTANCE_TEXELS + INSTANCE_WORDS_TEXEL)).x;
}
