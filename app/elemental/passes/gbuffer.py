"""The G-buffer: what every pixel's surface is. [Mittring12 "GBuffer" table]"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace

from elemental.core.layout import Block
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import D24S8, RGB10_A2, RGBA8, RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, TextureHandle
from elemental.gpu.shaders import Raster
from elemental.gpu.state import RasterState, Stencil
from elemental.passes.material_table import material_shader
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import OPAQUE, SOLID, Batch
from elemental.passes.view_draws import CAMERA, OCCLUDERS

VERT, FRAG = "gbuffer/gbuffer.vert.glsl", "gbuffer/gbuffer.frag.glsl"
STATE = RasterState(cull="back", depth_test="lequal")
CLEAR = (0.0, 0.0, 0.0, 0.0)
REFUSES_DECALS = 1
"""Bit of the stencil buffer, set where the nearest surface is of an instance without decals."""
MASKED_STATES = {
    receives: replace(STATE, stencil=Stencil(reference=0 if receives else REFUSES_DECALS,
                                             on_pass="replace"))
    for receives in (True, False)
}  # fmt: skip
"""By whether decals may draw, where any instance refuses them."""


MASKED = {"ALPHA_MASK": 1}
EMPTY = Raster(VERT, FRAG)
"""Clears the targets where nothing is drawn."""
DEPTH = Raster("gbuffer/depth.vert.glsl", "shadow/depth.frag.glsl")


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


def draw_gbuffer(
    g: Graph,
    view: Block,
    scene: GpuScene,
    size: tuple[int, int],
    culling: str = "occlusion",
) -> GBuffer:
    """Rasterize every opaque and masked surface.

    `view`: the packed block View; size in px; culling: one of view_draws.CULLING, what is not even
    sent to the rasterizer.
    """
    gb = GBuffer(
        depth=g.texture("gbuffer.depth", size=size, format=D24S8),
        scene_color=g.texture("scene_color", size=size, format=RGBA16F),
        a=g.texture("gbuffer.a", size=size, format=RGB10_A2),
        b=g.texture("gbuffer.b", size=size, format=RGBA8),
        c=g.texture("gbuffer.c", size=size, format=RGBA8),
        d=g.texture("gbuffer.d", size=size, format=RGBA8),
    )
    scene.in_view.begin(g, view, size, scene.version, culling)
    hides = scene.in_view.hides
    if hides:
        _draw_occluders(g, view, scene, gb.depth)
        scene.in_view.finish(g, view, gb.depth)
    groups: dict[tuple[Raster, bool], list[Batch]] = defaultdict(list)
    for batch in scene.batches(SOLID):
        defines = MASKED if batch.alpha_mode == "mask" else None
        groups[material_shader(VERT, FRAG, batch, defines), batch.receives_decals].append(batch)
    masked = any(not receives for _, receives in groups)
    for number, (key, batches) in enumerate((groups or {(EMPTY, True): []}).items()):
        shader, receives = key
        mask = batches[0].texture_mask if batches else 0

        def draw(enc: Encoder, batches: list[Batch] = batches, mask: int = mask) -> None:
            scene.draw(enc, batches, texture_mask=mask, seen_by=CAMERA)

        g.raster(
            shader,
            name=_name(batches),
            color=[gb.scene_color, gb.a, gb.b, gb.c, gb.d],
            depth=gb.depth,
            reads=scene.reads(),
            writes=scene.materials.writes(batches),
            params={"View": view, **scene.params()},
            state=MASKED_STATES[receives] if masked else STATE,
            clear_color=CLEAR if number == 0 else None,
            clear_depth=1.0 if number == 0 and not hides else None,
            clear_stencil=0 if number == 0 and not hides else None,
            draw=draw,
            uses=scene.uses(CAMERA),
        )
    return gb


def _draw_occluders(g: Graph, view: Block, scene: GpuScene, depth: TextureHandle) -> None:
    """The depth of what was seen before, into an empty buffer. The surfaces are then drawn on top,
    equally near: of those that are hidden none is shaded."""

    def draw(enc: Encoder) -> None:
        scene.draw_positions(enc, OPAQUE, seen_by=OCCLUDERS, cull=True)

    g.raster(
        DEPTH,
        "gbuffer.depth",
        depth=depth,
        reads={"u_instances": scene.instances},
        params={"View": view},
        state=STATE,
        clear_depth=1.0,
        clear_stencil=0,
        draw=draw,
        uses=scene.uses(OCCLUDERS),
    )


def _name(batches: list[Batch]) -> str:
    """Of a pass that draws batches of one program."""
    if not batches:
        return "gbuffer"
    batch = batches[0]
    uv = ".uv" if batch.uv_transforms else ""
    material = "" if batch.definition.is_standard else f".{batch.definition.name}"
    return f"gbuffer.{batch.alpha_mode}.{batch.texture_mask}{uv}{material}"
