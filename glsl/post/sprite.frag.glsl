// The shape of the aperture, in the light of one bright texel.
uniform sampler2D u_shape;

flat in vec3 v_light;
in vec2 v_uv;
out vec4 o_light;

void main() {
    o_light = vec4(v_light * texture(u_shape, v_uv).rgb, 1.0);
}
