// Half as large, through the tent 1 3 3 1: four bilinear lookups at the corners between four
// texels.
layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D u_finer;  // linear filter
layout(rgba16f) writeonly uniform image2D o_coarser;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(o_coarser);
    if (any(greaterThanEqual(texel, size))) return;
    vec2 uv = (vec2(texel) + 0.5) / vec2(size);
    vec2 reach = 0.75 / vec2(textureSize(u_finer, 0));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        sum += textureLod(u_finer, uv + reach * (2.0 * vec2(i & 1, i >> 1) - 1.0), 0.0);
    }
    imageStore(o_coarser, texel, 0.25 * sum);
}
