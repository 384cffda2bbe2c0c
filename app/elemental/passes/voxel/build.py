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
from elemental.gpu.refs import AnyBuffer, Ref
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


def find_nodes(g: Graph, octree: Survey, fragments: AnyBuffer) -> dict[str, Ref]:
    """Which points are occupied, which nodes exist, and the nodes' ranks, by GLSL name.

    Leaves the totals and the arguments of later dispatches in the octree's state.
    """
    grid = octree.grid
    points = g.buffer("voxel.points", grid.point_block_count * BLOCK_BYTES)
    node_bits = g.buffer("voxel.node_bits", grid.block_count * BLOCK_BYTES)
    g.clear_buffer(points)
    g.clear_buffer(node_bits)
    g.compute(
        MARK,
        reads={"State": octree.state, "Fragments": fragments, "Regions": octree.regions},
        writes={"Points": points},
        params=octree.params,
        indirect=(octree.state, state_offset("fragments")),
    )
    for level in range(grid.leaf_level, -1, -1):
        g.compute(
            REDUCE,
            f"reduce.{level}",
            reads={"Regions": octree.regions},
            writes={"Points": points, "NodeBits": node_bits},
            params={**octree.params, "OctreeLevel": level_params(level)},
            threads=grid.grid_blocks(level + 1),
        )
    group_blocks = int(layouts().constant("SCAN_BLOCKS"))
    groups = -(-grid.block_count // group_blocks)
    ranks = g.buffer("voxel.ranks", (grid.block_count + groups) * BLOCK_BYTES)
    g.compute(
        SCAN_BLOCKS,
        reads={"NodeBits": node_bits},
        writes={"Ranks": ranks},
        params=octree.params,
        groups=groups,
    )
    g.compute(
        SCAN_GROUPS,
        reads={"NodeBits": node_bits},
        writes={"Ranks": ranks, "State": octree.state},
        params=octree.params,
        groups=1,
    )
    return {"Points": points, "NodeBits": node_bits, "Ranks": ranks}


def build(g: Graph, octree: Octree, fragments: AnyBuffer) -> None:
    """Nodes, bricks and leaf attributes from the fragments."""
    found = find_nodes(g, octree, fragments)
    g.compute(
        NODES,
        reads={**found, "Regions": octree.regions},
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
    average(g, octree, fragments, found)


def average(g: Graph, octree: Octree, fragments: AnyBuffer, found: dict[str, Ref]) -> None:
    """Leaf attributes: the averages of each voxel's fragments, summed in integers.

    ``found`` is what `find_nodes` returned.
    """
    # Voxels without fragments stay as they are now.
    g.clear_buffer(octree.attributes)
    g.clear_buffer(octree.radiance)
    g.compute(
        LINK,
        reads={
            "State": octree.state,
            "Regions": octree.regions,
            "NodeBits": found["NodeBits"],
            "Ranks": found["Ranks"],
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
