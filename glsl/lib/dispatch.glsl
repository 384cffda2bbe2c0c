// One-dimensional dispatches of any length.
//
// GL 4.3 guarantees 65,535 work groups along an axis, so the frame graph (threads=n) and
// linear_dispatch_args() fold a longer dispatch into two dimensions. Shaders that include this
// file take their index from linear_thread_id() and leave where it is past their last item: the
// fold rounds up.

const uint MAX_WORK_GROUPS = 65535u;

// Index (uint) of this thread in a one-dimensional dispatch, folded or not. A macro, because
// gl_WorkGroupSize exists only below the shader's layout(local_size_x = ...) line.
#define linear_thread_id() \
    ((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) \
        * (gl_WorkGroupSize.x * gl_WorkGroupSize.y * gl_WorkGroupSize.z) \
        + gl_LocalInvocationIndex)

// For the producer of a list that a later indirect dispatch goes over: makes the dispatch's x and y
// reach item `at`. The slide's InterlockedMax, which saves a pass; its (at + 63) / 64 misses the
// first item of each group. [Mittring12 "Specular Sampling 2/2"]
const uint DISPATCH_ROW = 32768u;
#define reach_item(args_x, args_y, at, group_size) \
    atomicMax(args_x, min((at) / (group_size), DISPATCH_ROW - 1u) + 1u); \
    if ((at) / (group_size) >= DISPATCH_ROW) atomicMax(args_y, (at) / ((group_size) * DISPATCH_ROW) + 1u)

// Arguments of an indirect dispatch for `items` threads in groups of `group_size`.
uvec3 linear_dispatch_args(uint items, uint group_size) {
    uint groups = (items + group_size - 1u) / group_size;
    uint rows = (groups + MAX_WORK_GROUPS - 1u) / MAX_WORK_GROUPS;
    return uvec3(rows == 0u ? 0u : (groups + rows - 1u) / rows, max(rows, 1u), 1u);
}
