"""Which lights may reach which part of the view, or of the world: clustered light culling.

[Olsson12 "Clustered Deferred and Forward Shading"]
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.formats import R32UI
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.shadow import ShadowMaps
from elemental.passes.voxel.grid import Grid
from elemental.scene.model import Camera

ALL_LIGHTS = int(layouts().constant("ALL_LIGHTS"))
VIEW_CELLS = int(layouts().constant("VIEW_CELLS"))
WORLD_CELLS = int(layouts().constant("WORLD_CELLS"))
CULL = {
    kind: Compute("lights/cull.comp.glsl", {"LIGHT_CELLS": kind})
    for kind in (VIEW_CELLS, WORLD_CELLS)
}

TILE_PX = 16
"""Least side of a tile of the view, px."""
TILES_MAX = 40
"""Most tiles along a side of the view."""
SLICES = 32
"""Of the view's depth. With 256 lights in the atrium at 320x180, shading by these takes 0.8 of what
it takes with half as many slices and tiles twice as wide."""
FIRST_SLICE = 1.0 / 128.0
"""End of the first slice as a part of the view's depth, if that is beyond the near plane:
logarithmic slices would spend most of their number on the first decimetres [inferred]."""
WORLD_SIDE = 16
"""Cells along a side of the scene for voxel lighting: 8 voxels each at 128."""


@dataclass(frozen=True)
class LightCells:
    """The bits of a grid of cells, as shaders with LIGHT_CELLS = `kind` read them; None: no grid,
    every light may reach everywhere."""

    kind: int = ALL_LIGHTS
    bits: TextureHandle | None = None
    block: Block | None = None

    def reads(self) -> dict[str, Ref]:
        """Textures of lib/light_cells.glsl."""
        return {} if self.bits is None else {"u_light_bits": self.bits}

    def params(self) -> dict[str, Block]:
        """Uniform blocks of lib/light_cells.glsl."""
        return {} if self.block is None else {"LightCells": self.block}


NO_CELLS = LightCells()


def cull_to_view(
    g: Graph, view: Block, shadows: ShadowMaps, camera: Camera, size: tuple[int, int]
) -> LightCells:
    """For points that the camera sees. size: (width, height) px; view: the block View of it."""
    if not shadows.culled:
        return NO_CELLS
    tile_px = max(TILE_PX, math.ceil(max(size) / TILES_MAX))
    tangent = math.tan(camera.fov_y / 2)
    far, near = float(view["far"]), float(view["near"])
    first = min(max(near, far * FIRST_SLICE), 0.5 * far)
    block = pack(
        layouts().block("LightCells"),
        count=(math.ceil(size[0] / tile_px), math.ceil(size[1] / tile_px), SLICES),
        words=shadows.light_words,
        origin_ws=np.zeros(3),
        cell_m=0.0,
        tangents=(tangent * size[0] / size[1], tangent),
        first_depth_m=first,
        slices_an_octave=(SLICES - 1) / math.log2(far / first),
    )
    return _cull(g, "lights.view_cells", VIEW_CELLS, shadows, block, {"View": view})


def cull_to_world(g: Graph, shadows: ShadowMaps, grid: Grid) -> LightCells:
    """For the voxels of the scene."""
    if not shadows.culled:
        return NO_CELLS
    side = grid.size / 2.0  # the scene is the middle half of the cube
    block = pack(
        layouts().block("LightCells"),
        count=(WORLD_SIDE,) * 3,
        words=shadows.light_words,
        origin_ws=grid.origin + np.float32(side / 2.0),
        cell_m=side / WORLD_SIDE,
        tangents=(0.0, 0.0),
        first_depth_m=0.0,
        slices_an_octave=0.0,
    )
    return _cull(g, "lights.world_cells", WORLD_CELLS, shadows, block, {})


def _cull(
    g: Graph, name: str, kind: int, shadows: ShadowMaps, block: Block, params: dict[str, Block]
) -> LightCells:
    words = int(np.prod(block["count"], dtype=np.int64)) * int(block["words"])
    width = int(layouts().constant("LIGHT_BITS_WIDTH"))
    bits = g.texture(name, size=(width, math.ceil(words / width)), format=R32UI)
    g.compute(
        CULL[kind],
        name,
        reads={"LightBounds": shadows.light_bounds},
        writes={"o_light_bits": bits},
        params={"LightCells": block, **params},
        threads=words,
    )
    return LightCells(kind, bits, block)
