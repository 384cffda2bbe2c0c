"""Translucent surfaces over the shaded scene: sorted by instance, lit, shadowed, refracting.

[Mittring12 "GBuffer": "one forward pass"]
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby
from typing import Literal, TypeAlias

import numpy as np

from elemental.core.layout import Block
from elemental.gpu.encode import Encoder
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, Sampled, TextureHandle
from elemental.gpu.shaders import Raster
from elemental.gpu.state import RasterState
from elemental.passes.area_lights import NO_MAPS, area_maps
from elemental.passes.behind import grab_behind
from elemental.passes.camera_view import box_corners
from elemental.passes.gbuffer import VERT, GBuffer
from elemental.passes.light_cells import ALL_LIGHTS, NO_CELLS, VIEW_CELLS, LightCells
from elemental.passes.material_pack import ALL_SLOTS
from elemental.passes.material_table import material_shader
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import Array, Batch
from elemental.passes.shadow import ShadowMaps
from elemental.passes.sky import Sky
from elemental.passes.voxel.octree import Octree

FRAG = "forward/forward.frag.glsl"
VARIANTS = {
    (gi, cells, glass, soft): Raster(
        VERT,
        FRAG,
        defines={"GI": gi, "LIGHT_CELLS": cells, "TRANSMISSION": glass, "SOFT_SHADOWS": soft},
    )
    for gi in (0, 1)
    for cells in (ALL_LIGHTS, VIEW_CELLS)
    for glass, soft in ((0, 0), (0, 1), (1, 0))
}
"""Of glTF's material."""

Side = Literal["front", "back"]
STATES = {
    (glass, side): RasterState(
        cull="back" if side == "front" else "front",
        depth_test="lequal",
        depth_write=glass,
        blend="premultiplied",
    )
    for glass in (False, True)
    for side in ("front", "back")
}
"""By whether it refracts, and the side that is drawn. Glass replaces what is behind it, so the
nearest of its own surfaces has to win, whatever the order of its triangles."""

ScreenBox: TypeAlias = tuple[float, float, float, float]
"""Lowest x and y, highest x and y in clip space."""

GRABS_MAX = 4
"""Pictures of what is behind glass, at most; further layers share the last [inferred: what stands
five deep in glass is hardly told apart]."""


@dataclass(frozen=True)
class Layer:
    """One side of a translucent instance; `grab`: the picture it looks through, -1 for none."""

    batch: Batch
    side: Side
    grab: int

    @property
    def state(self) -> RasterState:
        """How it is drawn."""
        return STATES[self.grab >= 0, self.side]


def draw_translucent(
    g: Graph,
    view: Block,
    gb: GBuffer,
    scene: GpuScene,
    shadows: ShadowMaps,
    *,
    sky: Sky,
    cells: LightCells = NO_CELLS,
    gathered: tuple[Octree, Block] | None = None,
) -> TextureHandle:
    """Blend what is seen of the translucent instances onto `gb.scene_color`, the farthest first.

    gathered: the octree and the AreaLights whose light they gather; none without it.
    """
    clip_from_world = np.asarray(view["clip_from_world"]).T
    layers = list(layers_of(scene, clip_from_world, np.asarray(view["eye_ws"])))
    if not layers:
        return gb.scene_color
    reads: dict[str, Ref] = {
        **scene.reads(),
        **shadows.light_reads(),
        **cells.reads(),
        **sky.reads(),
    }
    blocks = [scene.params(), shadows.params(), cells.params(), sky.params()]
    if gathered is not None:
        octree, area_lights = gathered
        reads |= octree.tracing_reads()
        blocks += [octree.params, {"AreaLights": area_lights}]
    params = {"View": view, **{name: block for some in blocks for name, block in some.items()}}
    maps = NO_MAPS if gathered is None else area_maps(gathered[1])
    defines = {"GI": int(gathered is not None), "LIGHT_CELLS": cells.kind, "AREA_MAPS": maps}

    def key(layer: Layer) -> tuple[Raster, RasterState, int]:
        # Glass keeps hard shadows: with what is behind it the 16 textures that every driver has
        # may all be taken.
        glass = layer.grab >= 0
        own = {"TRANSMISSION": int(glass), "SOFT_SHADOWS": int(shadows.soft and not glass)}
        shader = material_shader(
            VERT, FRAG, layer.batch, defines | own, texture_mask=ALL_SLOTS, uv_transforms=True
        )
        return shader, layer.state, layer.grab

    behind: Sampled | None = None
    newest = -1
    for (shader, state, grab), run in groupby(layers, key):
        if grab > newest:
            newest, behind = grab, grab_behind(g, view, gb, grab)
        batches = [layer.batch for layer in run]
        _draw(
            g,
            gb,
            scene,
            shader,
            state,
            batches,
            reads | shadows.view_reads() if grab < 0 else _with(reads, behind),
            params,
        )
    return gb.scene_color


def _with(reads: Mapping[str, Ref], behind: Sampled | None) -> dict[str, Ref]:
    assert behind is not None, "glass looks through a picture"
    return {**reads, "u_behind": behind}


def _draw(
    g: Graph,
    gb: GBuffer,
    scene: GpuScene,
    shader: Raster,
    state: RasterState,
    batches: list[Batch],
    reads: Mapping[str, Ref],
    params: Mapping[str, Block],
) -> None:
    def draw(enc: Encoder) -> None:
        scene.draw_sorted(enc, batches)

    g.raster(
        shader,
        color=gb.scene_color,
        depth=gb.depth,
        reads=reads,
        writes=scene.materials.writes(batches),
        params=params,
        state=state,
        draw=draw,
    )


def layers_of(scene: GpuScene, clip_from_world: Array, eye: Array) -> Iterator[Layer]:
    """What is seen of the translucent instances, the farthest first, with its pictures.

    Of a double-sided one the back faces come before the front. Glass looks through a new picture
    where anything was drawn, since the last one, in its part of the view. eye (3,) m.
    """
    grab = -1
    drawn: list[ScreenBox] = []
    for batch in scene.back_to_front(eye, clip_from_world):
        box = screen_box(clip_from_world, *scene.box(batch.instance))
        sides: tuple[Side, ...] = ("back", "front") if batch.double_sided else ("front",)
        for side in sides:
            glass = scene.transmits(batch)
            fresh = grab < 0 or any(_overlap(box, other) for other in drawn)
            if glass and fresh and grab + 1 < GRABS_MAX:
                grab += 1
                drawn.clear()
            drawn.append(box)
            yield Layer(batch, side, grab if glass else -1)


def screen_box(clip_from_world: Array, low: Array, high: Array) -> ScreenBox:
    """That of a world box; all of the picture where the eye is inside."""
    corners = box_corners(low, high).astype(np.float64)
    clip = corners @ clip_from_world[:, :3].T + clip_from_world[:, 3]
    if clip[:, 3].min() <= 0.0:
        return -1.0, -1.0, 1.0, 1.0
    xy = clip[:, :2] / clip[:, 3:]
    return (*xy.min(axis=0).tolist(), *xy.max(axis=0).tolist())


def _overlap(a: ScreenBox, b: ScreenBox) -> bool:
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]
