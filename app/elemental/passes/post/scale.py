"""Halving a picture's size."""

from __future__ import annotations

from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Sampled, TextureHandle
from elemental.gpu.shaders import Raster

TRIANGLE = "post/triangle.vert.glsl"
DOWNSAMPLE = Raster(TRIANGLE, "post/downsample.frag.glsl")


def half_size(size: tuple[int, ...]) -> tuple[int, int]:
    """(width, height) whose texel i stands for texels 2i and 2i + 1, the last one perhaps alone."""
    return (size[0] + 1) // 2, (size[1] + 1) // 2


def downsample(g: Graph, picture: AnyTexture, name: str = "half") -> TextureHandle:
    """Means of 2x2 texels of `picture` (H, W), its last row and column repeated: RGBA16F."""
    half = g.texture(name, size=half_size(picture.size), format=RGBA16F)
    g.raster(
        DOWNSAMPLE,
        f"post.{name}",
        color=half,
        reads={"u_picture": Sampled(picture, "linear")},
    )
    return half
