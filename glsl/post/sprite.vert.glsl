// One quad a sprite, half a texel wider than its shape, whose edge is soft.
#include "shared/lens_flare.glsl"

uniform sampler2D u_sprites;
uniform sampler2D u_picture;

flat out vec3 v_light;
out vec2 v_uv;

void main() {
    vec4 sprite = texelFetch(u_sprites, ivec2(uint(gl_InstanceID) % SPRITE_COLUMNS,
                                              uint(gl_InstanceID) / SPRITE_COLUMNS), 0);
    ivec2 size = textureSize(u_picture, 0);
    int texel = int(sprite.a);
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    float reach = u_flare.sprite_radius + 0.5;
    vec2 place = vec2(texel % size.x, texel / size.x) + 0.5 + reach * corner;
    v_uv = 0.5 + 0.5 * corner * reach / u_flare.sprite_radius;
    v_light = u_flare.sprite_share * sprite.rgb;
    gl_Position = vec4(2.0 * place / vec2(size) - 1.0, 0.0, 1.0);
}
