// Opaque surfaces need no colour; masked ones their alpha test.
#ifdef ALPHA_MASK
#include "lib/material.glsl"

in vec2 v_uv0;
in vec2 v_uv1;
in float v_alpha;
flat in uint v_material;

void main() {
    float opacity = material_opacity(v_material, v_uv0, v_uv1, v_alpha);
    if (opacity < materials[v_material].alpha_cutoff) discard;
}
#else
void main() {}
#endif
