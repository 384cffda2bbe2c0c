"""The G-buffer's smart blur: less specular aliasing and dither. [Mittring12 "G-buffer Blur"]"""

from __future__ import annotations

from dataclasses import replace

from elemental.core.layout import Block
from elemental.gpu.formats import RGB10_A2, RGBA8
from elemental.gpu.graph import Graph
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer

BLUR = Compute("gbuffer_blur/blur.comp.glsl")


def blur_gbuffer(g: Graph, view: Block, gb: GBuffer) -> GBuffer:
    """The G-buffer with normals and ambient occlusion averaged over five pixels of one surface.

    Its specular powers are reduced by how much the normals differ [Toksvig05].
    """
    blurred = replace(
        gb,
        a=g.texture("gbuffer.a.blurred", size=gb.depth.size, format=RGB10_A2),
        b=g.texture("gbuffer.b.blurred", size=gb.depth.size, format=RGBA8),
        d=g.texture("gbuffer.d.blurred", size=gb.depth.size, format=RGBA8),
    )
    g.compute(
        BLUR,
        reads={
            "u_depth": gb.depth,
            "u_gbuffer_a": gb.a,
            "u_gbuffer_b": gb.b,
            "u_gbuffer_d": gb.d,
        },
        writes={"o_a": blurred.a, "o_b": blurred.b, "o_d": blurred.d},
        params={"View": view},
        threads=gb.depth.size,
    )
    return blurred
