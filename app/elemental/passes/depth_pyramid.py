"""The farthest depths of squares of pixels, against which boxes are found to be hidden."""

from __future__ import annotations

from elemental.core.layout import layouts, pack
from elemental.gpu.formats import R32F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Mip, Ref, TextureHandle
from elemental.gpu.shaders import Compute

PASSES = {
    level: Compute("cull/depth_pyramid.comp.glsl", defines={"LEVEL": level}) for level in (0, 4)
}
"""By the first of the four levels that each writes."""
LEVELS = 8
"""Of the pyramid: texels of 2 to 256 pixels a side."""
TILE = 16
"""Texels a side that a group of threads reduces to one, four levels up."""


def depth_pyramid(g: Graph, depth: AnyTexture) -> TextureHandle:
    """R32F of LEVELS levels: the farthest depth of squares of 2, 4, … pixels a side.

    Its sides are powers of two, so that every texel stands for whole squares; those past the
    picture's rim hold nothing.
    """
    size = depth.size[:2]
    smallest = 1 << LEVELS
    base = [max(1 << (side - 1).bit_length() >> 1, smallest) for side in size]
    pyramid = g.texture("depth.pyramid", size=(base[0], base[1]), format=R32F, mips=LEVELS)
    reads: dict[str, Ref] = {"u_depth": depth}
    for level, shader in PASSES.items():
        groups = [-(-side // TILE) for side in size]
        writes: dict[str, Ref] = {f"o_level{n}": Mip(pyramid, level + n) for n in range(4)}
        params = {"DepthPyramid": pack(layouts().block("DepthPyramid"), source_size=size)}
        g.compute(
            shader, f"depth.pyramid.{level}", reads=reads, writes=writes,
            params=params, groups=groups,
        )  # fmt: skip
        reads, size = {"u_finer": Mip(pyramid, level + 3)}, (groups[0], groups[1])
    return pyramid
