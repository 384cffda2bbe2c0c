"""Translucent surfaces over the shaded scene: sorted by instance, lit and shadowed.

[Mittring12 "GBuffer": "one forward pass"]
"""

from __future__ import annotations

from itertools import groupby

from elemental.core.layout import Block
from elemental.gpu.encode import Encoder
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, TextureHandle
from elemental.gpu.shaders import Raster
from elemental.gpu.state import RasterState
from elemental.passes.gbuffer import VERT, VIEWER, GBuffer
from elemental.passes.light_cells import ALL_LIGHTS, NO_CELLS, VIEW_CELLS, LightCells
from elemental.passes.material_pack import ALL_SLOTS
from elemental.passes.material_table import material_shader
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import BLEND, Batch
from elemental.passes.shadow import ShadowMaps
from elemental.passes.sky import Sky

FRAG = "forward/forward.frag.glsl"
VARIANTS = {
    (gi, cells): Raster(VERT, FRAG, defines={"GI": gi, "LIGHT_CELLS": cells})
    for gi in (0, 1)
    for cells in (ALL_LIGHTS, VIEW_CELLS)
}
"""Of glTF's material."""
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
    reads: dict[str, Ref] = {
        **scene.reads(),
        **shadows.light_reads(),
        **cells.reads(),
        **sky.reads(),
    }
    if diffuse_gi is not None:
        reads["u_diffuse_gi"] = diffuse_gi

    blocks = (scene.params(), shadows.params(), cells.params(), sky.params())
    params = {"View": view, **{name: block for some in blocks for name, block in some.items()}}
    defines = {"GI": int(diffuse_gi is not None), "LIGHT_CELLS": cells.kind}

    def program(batch: Batch) -> Raster:
        return material_shader(
            VERT, FRAG, batch, defines, texture_mask=ALL_SLOTS, uv_transforms=True
        )

    for shader, run in groupby(scene.back_to_front(view["eye_ws"]), program):
        batches = list(run)

        def draw(enc: Encoder, batches: list[Batch] = batches) -> None:
            scene.draw(enc, batches, seen_by=VIEWER)

        g.raster(
            shader,
            color=gb.scene_color,
            depth=gb.depth,
            reads=reads,
            writes=scene.materials.writes(batches),
            params=params,
            state=STATE,
            draw=draw,
        )
    return gb.scene_color
