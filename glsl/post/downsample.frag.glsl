// Means of 2x2 texels. Texel i of the target covers 2i and 2i + 1 of the source whatever its size,
// so that no energy is gained or lost; beyond the edge the source repeats.
uniform sampler2D u_picture;

out vec4 o_color;

void main() {
    vec2 corner = 2.0 * gl_FragCoord.xy / vec2(textureSize(u_picture, 0));
    o_color = textureLod(u_picture, corner, 0.0);
}
