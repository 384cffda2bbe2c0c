// Arguments of an indirect dispatch, as the octree's state keeps them.

#include "lib/dispatch.glsl"
#include "shared/octree.glsl"

DispatchArgs dispatch_args(uint threads, uint group) {
    uvec3 groups = linear_dispatch_args(threads, group);
    return DispatchArgs(groups.x, groups.y, groups.z, threads);
}
