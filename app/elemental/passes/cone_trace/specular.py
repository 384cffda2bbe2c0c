"""Indirect glossy light. [Mittring12 "Specular Sampling 1/2"]"""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer
from elemental.passes.sky import Sky
from elemental.passes.voxel.octree import Octree

TRACE = Compute("cone_trace/specular.comp.glsl")


def trace_specular(
    g: Graph, view: Block, gb: GBuffer, octree: Octree, sky: Sky, diffuse_gi: TextureHandle
) -> TextureHandle:
    """Radiance along the mirrored eye vector, (H, W) RGBA16F; a: visibility of the sky.

    The cone is as wide as the surface's specular lobe; a broad lobe on a dim surface takes what the
    diffuse cones gathered.
    """
    specular = g.texture("specular_gi", like=gb.depth, format=RGBA16F)
    g.compute(
        TRACE,
        "cones.specular",
        reads={
            "u_depth": gb.depth,
            "u_gbuffer_a": gb.a,
            "u_gbuffer_b": gb.b,
            "u_gbuffer_d": gb.d,
            "u_diffuse_gi": diffuse_gi,
            **octree.tracing_reads(),
            **sky.reads(),
        },
        writes={"o_specular_gi": specular},
        params={"View": view, **octree.params, **sky.params()},
        threads=gb.depth.size[:2],
    )
    return specular
