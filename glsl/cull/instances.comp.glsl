// Draw commands that are left with the instances that a view may see. Those of a command keep their
// order, so that what is equally near is settled as without culling.
//
// STAGE 0: occluders, to be drawn first for their depth: instances seen in the last frame and
//          still in the frustum whose footprint is at least OCCLUDER_PX pixels for each triangle,
//          or is not known as the eye's or the near plane cuts their box.
// STAGE 1: those, and what their depth does not hide; notes what is seen for the frame after.
// STAGE 2: what is in the frustum.
// [Wihlidal16 "Optimizing the Graphics Pipeline with Compute"],
// [Haar15 "GPU-Driven Rendering Pipelines"]
#include "lib/dispatch.glsl"
#include "lib/occlusion.glsl"
#include "shared/culling.glsl"
#include "shared/draw_command.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Everything { DrawCommand everything[]; };  // every instance's
layout(std430) readonly buffer Order { uint order[]; };                  // instances by place
layout(std430) readonly buffer Boxes { InstanceBox boxes[]; };
layout(std430) writeonly buffer Commands { DrawCommand commands[]; };
layout(std430) writeonly buffer Drawn { uint drawn_order[]; };
#if STAGE == 0 || STAGE == 1
layout(std430) buffer Seen { uint seen[]; };  // SEEN, OCCLUDES by place
#endif
#if STAGE != 0
layout(std430) buffer Counts { CullCounts counts; };
#endif
#if STAGE == 1
uniform sampler2D u_depth_pyramid;
#endif

const uint SEEN = 1u;      // when last looked for
const uint OCCLUDES = 2u;  // is drawn for its depth in this frame
// Pixels of its footprint for each triangle that make an occluder worth drawing twice [measured].
const int OCCLUDER_PX = 8;

shared uint kept_through[CULL_GROUP];  // how many of the group are kept, by thread

// Instances of the group before this thread's that are kept; in y all of them.
uvec2 rank(uint thread, bool keep) {
    kept_through[thread] = uint(keep);
    barrier();
    for (uint stride = 1u; stride < CULL_GROUP; stride <<= 1) {
        uint left = thread >= stride ? kept_through[thread - stride] : 0u;
        barrier();
        kept_through[thread] += left;
        barrier();
    }
    uvec2 ranks = uvec2(kept_through[thread] - uint(keep), kept_through[CULL_GROUP - 1u]);
    barrier();
    return ranks;
}

// Whether to draw the instance at a place, of so many triangles.
bool is_drawn(uint place, uint triangles) {
    InstanceBox box = boxes[order[place]];
    bool in_frustum = box.visible != 0.0 && is_in_frustum(box.low, box.high);
#if STAGE == 0 || STAGE == 1
    Footprint footprint;
    bool is_whole = in_frustum && find_footprint(box.low, box.high, footprint);
#endif
#if STAGE == 0
    bool occludes = in_frustum && (seen[place] & SEEN) != 0u;
    if (occludes && is_whole) {
        ivec2 side = footprint.to - footprint.from;
        occludes = side.x * side.y >= OCCLUDER_PX * int(triangles);
    }
    seen[place] = occludes ? SEEN | OCCLUDES : 0u;
    return occludes;
#elif STAGE == 1
    bool occludes = (seen[place] & OCCLUDES) != 0u;
    bool hidden = is_whole && is_hidden(u_depth_pyramid, footprint);
    seen[place] = in_frustum && !hidden ? SEEN : 0u;
    if (!in_frustum) atomicAdd(counts.outside, 1u);
    if (hidden && !occludes) atomicAdd(counts.hidden, 1u);
    return in_frustum && (occludes || !hidden);
#else
    if (!in_frustum) atomicAdd(counts.outside, 1u);
    return in_frustum;
#endif
}

void main() {
    uint number = linear_thread_id() / CULL_GROUP;
    uint thread = gl_LocalInvocationIndex;
    if (number >= u_culling.command_count) return;
    DrawCommand command = everything[number];
    uint kept = 0u;
    for (uint begin = 0u; begin < command.instance_count; begin += CULL_GROUP) {
        uint place = command.base_instance + begin + thread;
        bool keep = begin + thread < command.instance_count && is_drawn(place, command.count / 3u);
        uvec2 ranks = rank(thread, keep);
        if (keep) drawn_order[command.base_instance + kept + ranks.x] = order[place];
        kept += ranks.y;
    }
    if (thread != 0u) return;
    command.instance_count = kept;
    commands[number] = command;
#if STAGE != 0
    atomicAdd(counts.drawn, kept);
    atomicAdd(counts.triangles_drawn, kept * (command.count / 3u));
#endif
}
