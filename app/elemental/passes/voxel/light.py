"""Voxel radiance and its directional mip-maps. [Mittring12 "Voxel Lighting Pipeline"]"""

from __future__ import annotations

from typing import TYPE_CHECKING

from elemental.core.layout import Block
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyBuffer
from elemental.gpu.shaders import Compute
from elemental.passes.area_lights import ALL_MAPS, NO_MAPS, SOME_MAPS, area_maps
from elemental.passes.light_cells import ALL_LIGHTS, NO_CELLS, WORLD_CELLS, LightCells
from elemental.passes.voxel.build import level_params, state_offset
from elemental.passes.voxel.octree import SIDED_BYTES_A_BRICK, Octree

if TYPE_CHECKING:
    from elemental.passes.shadow import ShadowMaps
    from elemental.passes.sky import Sky

GATHER = {"GATHER": 1, "CONE_SPLIT": 4, "SHARED": 1, "CLEARANCE": 16}
GATHERS: dict[str, dict[str, int]] = {
    "nothing": {},
    "present": GATHER,
    "last": {**GATHER, "SPREAD": 1},
}
"""Whose radiance is gathered, that of this frame or of the last -> defines."""
LIGHT = {
    (gathered, cells, maps): Compute(
        "voxel/light.comp.glsl", {**defines, "LIGHT_CELLS": cells, "AREA_MAPS": maps}
    )
    for gathered, defines in GATHERS.items()
    for cells in (ALL_LIGHTS, WORLD_CELLS)
    for maps in (NO_MAPS, SOME_MAPS, ALL_MAPS)
    if defines or maps == NO_MAPS
}
"""By what is gathered, how lights are found, and which area lights have shadow maps."""


def _reader(path: str, kind: str, one_leaf_level: bool, listed: bool = False) -> Compute:
    """A shader that reads "leaf" or "filtered" voxels, or "either" (lib/sided_voxel.glsl)."""
    level = int(one_leaf_level)
    return Compute(
        path,
        {"VOXEL_KIND": f"{kind.upper()}_VOXELS", "ONE_LEAF_LEVEL": level, "LISTED": int(listed)},
    )


FLAGS = (False, True)
FILTER = {
    (kind, one): _reader("voxel/filter.comp.glsl", kind, one)
    for kind in ("leaf", "filtered", "either")
    for one in FLAGS
}
"""By what the finer voxels are, and whether there is one leaf level."""
COMPRESS = {
    (one, listed): _reader("voxel/compress.comp.glsl", "filtered" if one else "either", one, listed)
    for one in FLAGS
    for listed in FLAGS
}
"""By whether there is one leaf level, and whether the bricks are listed."""
COMPRESS_LEAVES = {
    (one, listed): _reader("voxel/compress_leaves.comp.glsl", "leaf", one, listed)
    for one in FLAGS
    for listed in FLAGS
}


def light_voxels(
    g: Graph,
    octree: Octree,
    shadows: ShadowMaps,
    sky: Sky,
    area_lights: Block,
    gather: bool,
    of_last_frame: bool = False,
    cells: LightCells = NO_CELLS,
) -> None:
    """Radiance of the listed leaf voxels: emission and direct light through the shadow maps.

    ``gather``: also what arrives by cones through the octree's present radiance and from
    ``area_lights``, one more bounce; ``of_last_frame``: that radiance is of the frame before.
    ``cells``: of `cull_to_world`.
    """
    reads = {
        "State": octree.state,
        "Bricks": octree.bricks,
        "Attributes": octree.attributes,
        "VoxelList": octree.voxel_list,
        **shadows.light_reads(),
        **cells.reads(),
    }
    params = {**octree.params, **shadows.params(), **cells.params()}
    if gather:
        reads |= {**octree.tracing_reads(), **sky.reads()}
        params |= {"AreaLights": area_lights, **sky.params()}
    gathered = ("last" if of_last_frame else "present") if gather else "nothing"
    maps = area_maps(area_lights) if gather else NO_MAPS
    g.compute(
        LIGHT[gathered, cells.kind, maps],
        "light voxels",
        reads=reads,
        writes={"Radiance": octree.radiance},
        params=params,
        indirect=(octree.state, state_offset("leaf_voxels")),
    )


def filter_levels(g: Graph, octree: Octree, kept: AnyBuffer | None = None) -> AnyBuffer:
    """Six-sided values of the listed voxels above the finest level, from the finest up.

    SIDED_BYTES_A_BRICK each, in ``kept``, or in a buffer of this frame.
    """
    sided = kept
    if sided is None:
        sided = g.buffer("voxel.sided", max(octree.capacity.interior, 1) * SIDED_BYTES_A_BRICK)
        g.clear_buffer(sided)
    grid = octree.grid
    for level in range(grid.leaf_level - 1, -1, -1):
        finer = level + 1
        kind = "filtered" if finer < grid.coarsest_leaf else "either"
        if finer == grid.leaf_level:
            kind = "leaf"
        g.compute(
            FILTER[kind, grid.one_leaf_level],
            f"filter.{level}",
            reads={
                **octree.voxel_reads(),
                "NodeBlocks": octree.node_blocks,
                "VoxelList": octree.voxel_list,
            },
            writes={"Sided": sided},
            params={**octree.params, "OctreeLevel": level_params(level)},
            indirect=(octree.state, state_offset("level_voxels", level)),
        )
    return sided


def compress(g: Graph, octree: Octree, sided: AnyBuffer) -> None:
    """The bricks' texels with the redundant border, and their HDR multipliers.

    Of every brick, or, where bricks keep their slots, of the listed ones.
    """
    grid = octree.grid
    reads = {**octree.voxel_reads(), "NodeBlocks": octree.node_blocks, "Sided": sided}
    if octree.keeps_slots:
        reads["VoxelList"] = octree.voxel_list
    else:
        for atlas in (octree.atlas, octree.leaf_colors, octree.leaf_normals):
            g.clear_texture(atlas)
    g.compute(
        COMPRESS[grid.one_leaf_level, octree.keeps_slots],
        reads=reads,
        writes={"ScaledNodes": octree.nodes, "u_atlas": octree.atlas},
        params=octree.params,
        indirect=(octree.state, state_offset("interior_bricks")),
    )
    g.compute(
        COMPRESS_LEAVES[grid.one_leaf_level, octree.keeps_slots],
        reads=reads,
        writes={
            "ScaledNodes": octree.nodes,
            "u_colors": octree.leaf_colors,
            "u_normals": octree.leaf_normals,
        },
        params=octree.params,
        indirect=(octree.state, state_offset("leaf_bricks")),
    )
