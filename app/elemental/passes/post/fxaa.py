"""Antialiasing of the finished picture's edges. [Mittring12 "Real-time Demo"], [Lottes09]"""

from __future__ import annotations

from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Sampled, TextureHandle
from elemental.gpu.shaders import Raster

FXAA = Raster("post/triangle.vert.glsl", "post/fxaa.frag.glsl")


def fxaa(g: Graph, image: AnyTexture) -> TextureHandle:
    """`image` (H, W) RGBA8, display codes, with its edges smoothed; flat areas keep their bits."""
    smooth = g.texture("fxaa", like=image)
    g.raster(FXAA, color=smooth, reads={"u_image": Sampled(image, filter="linear")})
    return smooth
