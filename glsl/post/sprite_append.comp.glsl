// A sprite for each very bright texel, in the texels' order, so that sums of sprites come out the
// same every time. [Mittring12 "Image Based Lens Flares": "Render a textured sprite for each very
// bright low res pixel"]
layout(local_size_x = 256) in;  // SCAN_GROUP

#include "lib/bright.glsl"
#include "lib/dispatch.glsl"
#include "lib/prefix_sum.glsl"

layout(std430) readonly buffer RunCounts { uint run_counts[]; };
layout(std430) writeonly buffer Sprites { SpriteCounts counts; };
layout(rgba32f) writeonly uniform image2D o_sprites;  // rgb: light; a: texel

const uint QUAD_INDICES = 6u;

void main() {
    uint thread = gl_LocalInvocationIndex;
    uint texel = linear_thread_id();
    uint run = texel / SCAN_GROUP;
    uint earlier = 0u;
    for (uint k = thread; k < run; k += SCAN_GROUP) earlier += run_counts[k];
    vec3 light = bright_light(texel);
    uint is_bright = light != vec3(0.0) ? 1u : 0u;
    uvec2 sums = group_inclusive_sum(thread, uvec2(is_bright, earlier));
    barrier();
    uint before = scan_sums[SCAN_GROUP - 1u].y;
    uint sprite = before + sums.x - 1u;
    if (is_bright == 1u && sprite < u_flare.capacity) {
        ivec2 place = ivec2(sprite % SPRITE_COLUMNS, sprite / SPRITE_COLUMNS);
        imageStore(o_sprites, place, vec4(light, float(texel)));
    }
    uvec2 size = uvec2(textureSize(u_picture, 0));
    if (texel != size.x * size.y - 1u) return;
    uint bright = before + sums.x;
    counts = SpriteCounts(QUAD_INDICES, min(bright, u_flare.capacity), 0u, 0, 0u, bright, 0u, 0u);
}
