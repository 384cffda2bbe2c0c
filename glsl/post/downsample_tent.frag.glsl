// Half the size by a tent over 4x4 texels, [1 3 3 1]/8 along each axis: each texel of the source
// counts the same, and nothing flickers as it moves. [Mittring12 "Bloom"]: "Blur during
// downsample avoids aliasing"
uniform sampler2D u_picture;

out vec4 o_color;

const float BETWEEN = 0.75;  // texels from the 2x2 block's corner to a lookup at weights 1 : 3

void main() {
    vec2 size = vec2(textureSize(u_picture, 0));
    vec2 corner = 2.0 * gl_FragCoord.xy;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 offset = BETWEEN * (vec2(i & 1, i >> 1) * 2.0 - 1.0);
        sum += textureLod(u_picture, (corner + offset) / size, 0.0);
    }
    o_color = 0.25 * sum;
}
