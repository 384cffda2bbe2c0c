"""Smaller and larger pictures."""

from __future__ import annotations

from elemental.core.layout import layouts, pack
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, TextureHandle
from elemental.gpu.shaders import Raster

TRIANGLE = "post/triangle.vert.glsl"
DOWNSAMPLE = Raster(TRIANGLE, "post/downsample.frag.glsl")
UPSCALE = Raster(TRIANGLE, "post/upscale.frag.glsl")


def drawn_size(size: tuple[int, int], percentage: float) -> tuple[int, int]:
    """(width, height) that a picture of ``size`` px is drawn at, by the screen percentage."""
    width, height = (max(round(extent * percentage / 100.0), 1) for extent in size)
    return width, height


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
        reads={"u_picture": picture},
    )
    return half


def upscale(g: Graph, image: TextureHandle, size: tuple[int, ...]) -> TextureHandle:
    """`image`, RGBA8 display codes, at ``size``: a cubic without ringing. Itself at its own."""
    if image.size == size:
        return image
    shown = g.texture("upscale", size=size, like=image)
    ratio = [drawn / wanted for drawn, wanted in zip(image.size, size, strict=True)]
    block = pack(layouts().block("Upscale"), source_per_target=ratio)
    g.raster(UPSCALE, color=shown, reads={"u_image": image}, params={"Upscale": block})
    return shown
