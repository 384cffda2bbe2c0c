"""Antialiasing of the finished picture's edges. [Mittring12 "Real-time Demo"], [Lottes09]"""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Sampled, TextureHandle
from elemental.gpu.shaders import Compute

FXAA = Compute("post/fxaa.comp.glsl")


def fxaa(g: Graph, view: Block, image: AnyTexture) -> TextureHandle:
    """`image` (H, W) RGBA8, display codes, with its edges smoothed; flat areas keep their bits."""
    smooth = g.texture("fxaa", like=image)
    g.compute(
        FXAA,
        reads={"u_image": Sampled(image, filter="linear")},
        writes={"o_image": smooth},
        params={"View": view},
        threads=image.size,
    )
    return smooth
