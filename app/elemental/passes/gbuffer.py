"""The G-buffer: what every pixel's surface is. [Mittring12 "GBuffer" table]"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cache

import numpy as np

from elemental.core.layout import Block
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import D24S8, RGB10_A2, RGBA8, RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, TextureHandle
from elemental.gpu.shaders import Raster
from elemental.gpu.state import RasterState
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import SOLID, Batch
from elemental.scene.model import AlphaMode

VERT, FRAG = "gbuffer/gbuffer.vert.glsl", "gbuffer/gbuffer.frag.glsl"
STATE = RasterState(cull="back", depth_test="lequal")
VIEWER = "camera"
"""Whom GpuScene.look culls for here."""
CLEAR = (0.0, 0.0, 0.0, 0.0)


@cache
def _shader(alpha_mode: AlphaMode, texture_mask: int, uv_transforms: bool) -> Raster:
    defines = {"MATERIAL_TEXTURES": texture_mask, "MATERIAL_UV_TRANSFORMS": int(uv_transforms)}
    if alpha_mode == "mask":
        defines["ALPHA_MASK"] = 1
    return Raster(VERT, FRAG, defines=defines)


@dataclass(frozen=True)
class GBuffer:
    """Targets of one frame, all (W, H).

    depth D24S8; scene_color RGBA16F: emission, then accumulated radiance, alpha 1 where a surface
    is; a RGB10_A2 world normal, lighting model; b RGBA8 specular colour, ambient occlusion;
    c RGBA8 diffuse colour, decal mask; d RGBA8 specular power, subsurface colour.
    """

    depth: TextureHandle
    scene_color: TextureHandle
    a: TextureHandle
    b: TextureHandle
    c: TextureHandle
    d: TextureHandle

    def reads(self) -> dict[str, Ref]:
        """The depth and the four G-buffer targets by their GLSL names."""
        return {
            "u_depth": self.depth,
            "u_gbuffer_a": self.a,
            "u_gbuffer_b": self.b,
            "u_gbuffer_c": self.c,
            "u_gbuffer_d": self.d,
        }


def draw_gbuffer(g: Graph, view: Block, scene: GpuScene, size: tuple[int, int]) -> GBuffer:
    """Rasterize every opaque and masked surface. `view`: the packed block View; size in px."""
    gb = GBuffer(
        depth=g.texture("gbuffer.depth", size=size, format=D24S8),
        scene_color=g.texture("scene_color", size=size, format=RGBA16F),
        a=g.texture("gbuffer.a", size=size, format=RGB10_A2),
        b=g.texture("gbuffer.b", size=size, format=RGBA8),
        c=g.texture("gbuffer.c", size=size, format=RGBA8),
        d=g.texture("gbuffer.d", size=size, format=RGBA8),
    )
    scene.look(VIEWER, np.asarray(view["clip_from_world"]).T)
    groups: dict[tuple[AlphaMode, int, bool], list[Batch]] = defaultdict(list)
    for batch in scene.batches(SOLID):
        groups[batch.alpha_mode, batch.texture_mask, batch.uv_transforms].append(batch)
    for number, (key, batches) in enumerate((groups or {("opaque", 0, False): []}).items()):

        def draw(enc: Encoder, batches: list[Batch] = batches, mask: int = key[1]) -> None:
            scene.draw(enc, batches, texture_mask=mask, seen_by=VIEWER)

        g.raster(
            _shader(*key),
            name=f"gbuffer.{key[0]}.{key[1]}{'.uv' if key[2] else ''}",
            color=[gb.scene_color, gb.a, gb.b, gb.c, gb.d],
            depth=gb.depth,
            reads={"Instances": scene.instances, "Materials": scene.materials},
            params={"View": view},
            state=STATE,
            clear_color=CLEAR if number == 0 else None,
            clear_depth=1.0 if number == 0 else None,
            draw=draw,
        )
    return gb
