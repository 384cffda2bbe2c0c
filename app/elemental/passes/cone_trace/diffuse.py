"""Indirect diffuse light. [Mittring12 "Diffuse Sampling 2/2"], [Segovia06]"""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer
from elemental.passes.sky import Sky
from elemental.passes.voxel.octree import Octree

CONES = 9
"""Sub-images of the 3x3 pattern: CONE_COUNT of glsl/lib/cone_directions.glsl."""
SPLITS = (1, 4, 7)
"""Narrower cones that each of them may be traced as."""
TRACE = {n: Compute("cone_trace/diffuse.comp.glsl", defines={"CONE_SPLIT": n}) for n in SPLITS}
COMBINE = {n: Compute("cone_trace/combine.comp.glsl", defines={"CONE_SPLIT": n}) for n in SPLITS}
GROUP = 8
"""Threads a side of a work group."""


def trace_diffuse(
    g: Graph, view: Block, gb: GBuffer, octree: Octree, sky: Sky, split: int
) -> TextureHandle:
    """Nine sub-images of incoming radiance, one cone each: (3 ceil(H/3), 3 ceil(W/3)) RGBA16F.

    rgb: W/(m^2 sr); a: visibility of the sky, -1 where the cone is behind the surface.
    ``split``: of SPLITS.
    """
    width, height = (-(-side // 3) for side in gb.depth.size[:2])
    radiance = g.texture("cones.diffuse", size=(3 * width, 3 * height), format=RGBA16F)
    g.compute(
        TRACE[split],
        "cones.diffuse",
        reads={
            "u_depth": gb.depth,
            "u_gbuffer_a": gb.a,
            **octree.tracing_reads(),
            **sky.reads(),
        },
        writes={"o_radiance": radiance},
        params={"View": view, **octree.params, **sky.params()},
        groups=(-(-width // GROUP), -(-height // GROUP), CONES),
    )
    return radiance


def combine_diffuse(
    g: Graph, view: Block, gb: GBuffer, radiance: TextureHandle, split: int
) -> TextureHandle:
    """Irradiance / pi at every pixel, (H, W) RGBA16F; a: visibility of the sky, 0..1.

    ``split``: as for `trace_diffuse`.
    """
    diffuse = g.texture("diffuse_gi", like=gb.depth, format=RGBA16F)
    g.compute(
        COMBINE[split],
        "cones.combine",
        reads={"u_radiance": radiance, "u_depth": gb.depth, "u_gbuffer_a": gb.a},
        writes={"o_diffuse_gi": diffuse},
        params={"View": view},
        threads=gb.depth.size[:2],
    )
    return diffuse
