"""A picture of what is drawn already, for translucent surfaces to look through."""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Mip, Sampled, TextureHandle
from elemental.gpu.resources import mip_count
from elemental.gpu.shaders import Compute
from elemental.gpu.shape import level_size
from elemental.passes.gbuffer import GBuffer

GRAB = Compute("behind/grab.comp.glsl")
REDUCE = Compute("behind/reduce.comp.glsl")
LEVELS = 6
"""Of ever blurrier pictures: the last has texels of 32 pixels, which frosted glass blurs over."""


def grab_behind(g: Graph, view: Block, gb: GBuffer, number: int) -> Sampled:
    """`gb.scene_color` as it is now, with its blurrier levels: u_behind of lib/behind.glsl."""
    width, height = gb.depth.size[:2]
    levels = min(LEVELS, mip_count((width, height)))
    behind = g.texture(f"behind.{number}", size=(width, height), format=RGBA16F, mips=levels)
    g.compute(
        GRAB,
        reads={"u_scene_color": gb.scene_color, "u_depth": gb.depth},
        writes={"o_behind": Mip(behind, 0)},
        params={"View": view},
        threads=(width, height),
    )
    for level in range(1, levels):
        _reduce(g, behind, level)
    return Sampled(behind, filter="trilinear")


def _reduce(g: Graph, behind: TextureHandle, level: int) -> None:
    g.compute(
        REDUCE,
        f"behind/reduce.{level}",
        reads={"u_finer": Sampled(Mip(behind, level - 1), filter="linear")},
        writes={"o_coarser": Mip(behind, level)},
        threads=level_size(behind.desc.size, level)[:2],
    )
