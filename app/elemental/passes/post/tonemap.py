"""From scene-referred radiance to display codes."""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA8
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, TextureHandle
from elemental.gpu.shaders import Compute

TONEMAP = Compute("post/tonemap.comp.glsl")


def tonemap(g: Graph, view: Block, scene_color: AnyTexture) -> TextureHandle:
    """(H, W) RGBA8, sRGB encoded: the view's exposure, a filmic curve and dither."""
    image = g.texture("tonemap", size=scene_color.size, format=RGBA8)
    g.compute(
        TONEMAP,
        reads={"u_scene_color": scene_color},
        writes={"o_image": image},
        params={"View": view},
        threads=scene_color.size,
    )
    return image
