"""From the fragment queue to nodes, bricks and averaged attributes. [Mittring12 "Voxel Lighting
Pipeline": update octree data structures in parallel, stores voxel data in leaves]

Every node and brick gets its place by its rank in Morton order, from prefix sums over existence
bits, so that a build does not depend on the order in which threads ran.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyBuffer, BufferHandle
from elemental.gpu.shaders import Compute
from elemental.passes.voxel.octree import Octree, Survey

MARK = Compute("voxel/mark.comp.glsl")
REDUCE = Compute("voxel/reduce.comp.glsl")
SCAN_BLOCKS = Compute("voxel/scan_blocks.comp.glsl")
SCAN_GROUPS = Compute("voxel/scan_groups.comp.glsl")
NODES = Compute("voxel/nodes.comp.glsl")
LISTS = Compute("voxel/lists.comp.glsl")
LINK = Compute("voxel/link.comp.glsl")
RESOLVE = Compute("voxel/resolve.comp.glsl")

BLOCK_BYTES = 8


@cache
def level_params(level: int) -> Block:
    """The OctreeLevel block."""
    return pack(layouts().block("OctreeLevel"), level=level)


@cache
def state_offset(field: str, element: int = 0) -> int:
    """Byte offset of a DispatchArgs in OctreeState, for indirect dispatch."""
    layout = layouts().struct("OctreeState")
    dtype, offset = layout.fields[field][:2]  # type: ignore[index]
    stride = dtype.base.itemsize if isinstance(dtype, np.dtype) else 0
    return int(offset) + element * int(stride)


def find_nodes(g: Graph, octree: Survey, fragments: AnyBuffer) -> BufferHandle:
    """Which points are occupied, a bit each, and in the octree's blocks, which nodes exist.

    Leaves the totals and the arguments of later dispatches in the octree's state.
    """
    grid = octree.grid
    blocks = {"NodeBlocks": octree.node_blocks}
    points = g.buffer("voxel.points", grid.point_block_count * BLOCK_BYTES)
    mark(g, octree, fragments, points, octree.node_blocks)
    g.compute(SCAN_BLOCKS, writes=blocks, params=octree.params, groups=grid.scan_groups)
    g.compute(SCAN_GROUPS, writes={**blocks, "State": octree.state}, params=octree.params, groups=1)
    return points


def mark(
    g: Graph, octree: Survey, fragments: AnyBuffer, points: AnyBuffer, node_blocks: AnyBuffer
) -> None:
    """The bits of the points that the queue's fragments occupy, and of the nodes that touch one."""
    g.clear_buffer(points)
    g.clear_buffer(node_blocks)
    g.compute(
        MARK,
        reads={"State": octree.state, "Fragments": fragments, "Regions": octree.regions},
        writes={"Points": points},
        params=octree.params,
        indirect=(octree.state, state_offset("fragments")),
    )
    for level in range(octree.grid.leaf_level, -1, -1):
        g.compute(
            REDUCE,
            f"reduce.{level}",
            reads={"Regions": octree.regions},
            writes={"Points": points, "NodeBlocks": node_blocks},
            params={**octree.params, "OctreeLevel": level_params(level)},
            threads=octree.grid.grid_blocks(level + 1),
        )


def build(g: Graph, octree: Octree, fragments: AnyBuffer) -> None:
    """Nodes, bricks and leaf attributes from the fragments."""
    points = find_nodes(g, octree, fragments)
    g.compute(
        NODES,
        reads={"Points": points, "NodeBlocks": octree.node_blocks, "Regions": octree.regions},
        writes={
            "State": octree.state,
            "Nodes": octree.nodes,
            "Bricks": octree.bricks,
            "VoxelList": octree.voxel_list,
        },
        params=octree.params,
        threads=octree.grid.block_count,
    )
    g.compute(LISTS, writes={"State": octree.state}, params=octree.params, groups=1)
    average(g, octree, fragments)


def average(g: Graph, octree: Octree, fragments: AnyBuffer) -> None:
    """Leaf attributes: the averages of each voxel's fragments, summed in integers."""
    # Voxels without fragments stay as they are now.
    g.clear_buffer(octree.attributes)
    g.clear_buffer(octree.radiance)
    g.compute(
        LINK,
        reads={
            "State": octree.state,
            "Regions": octree.regions,
            "NodeBlocks": octree.node_blocks,
        },
        writes={"Fragments": fragments, "Attributes": octree.attributes},
        params=octree.params,
        indirect=(octree.state, state_offset("fragments")),
    )
    g.compute(
        RESOLVE,
        reads={
            "State": octree.state,
            "Fragments": fragments,
            "VoxelList": octree.voxel_list,
        },
        writes={"Attributes": octree.attributes},
        params=octree.params,
        indirect=(octree.state, state_offset("leaf_voxels")),
    )
