"""Translucent surfaces over the shaded scene: sorted by instance, lit and shadowed.

[Mittring12 "GBuffer": "one forward pass"]
"""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.encode import Encoder
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, TextureHandle
from elemental.gpu.shaders import Raster
from elemental.gpu.state import RasterState
from elemental.passes.gbuffer import VERT, VIEWER, GBuffer
from elemental.passes.light_cells import ALL_LIGHTS, NO_CELLS, VIEW_CELLS, LightCells
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import BLEND
from elemental.passes.shadow import ShadowMaps
from elemental.passes.sky import Sky

FRAG = "forward/forward.frag.glsl"
VARIANTS = {
    (gi, cells): Raster(VERT, FRAG, defines={"GI": gi, "LIGHT_CELLS": cells})
    for gi in (0, 1)
    for cells in (ALL_LIGHTS, VIEW_CELLS)
}
STATE = RasterState(cull="back", depth_test="lequal", depth_write=False, blend="premultiplied")


def draw_translucent(
    g: Graph,
    view: Block,
    gb: GBuffer,
    scene: GpuScene,
    shadows: ShadowMaps,
    *,
    sky: Sky,
    cells: LightCells = NO_CELLS,
    diffuse_gi: TextureHandle | None = None,
) -> TextureHandle:
    """Blend the scene's translucent instances onto `gb.scene_color`, the farthest first.

    diffuse_gi: (H, W) irradiance / pi, a: visibility of the sky, of the surfaces behind.
    """
    if not scene.batches(BLEND):
        return gb.scene_color
    reads: dict[str, Ref] = {"Instances": scene.instances, "Materials": scene.materials}
    reads |= {**shadows.reads(), **cells.reads(), **sky.reads()}
    if diffuse_gi is not None:
        reads["u_diffuse_gi"] = diffuse_gi

    def draw(enc: Encoder) -> None:
        scene.draw(enc, scene.back_to_front(view["eye_ws"]), seen_by=VIEWER)

    g.raster(
        VARIANTS[int(diffuse_gi is not None), cells.kind],
        color=gb.scene_color,
        depth=gb.depth,
        reads=reads,
        params={"View": view, **shadows.params(), **cells.params(), **sky.params()},
        state=STATE,
        draw=draw,
    )
    return gb.scene_color
