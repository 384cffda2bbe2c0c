"""Indirect light through surfaces of the subsurface lighting model."""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer
from elemental.passes.sky import Sky
from elemental.passes.voxel.octree import Octree

TRACE = Compute("cone_trace/through.comp.glsl", defines={"CONE_SPLIT": 1})


def light_from_behind(
    g: Graph,
    view: Block,
    gb: GBuffer,
    octree: Octree,
    sky: Sky,
    diffuse_gi: AnyTexture,
) -> TextureHandle:
    """`gb.scene_color` once shaded, with half of the light that shone through taken from behind.

    diffuse_gi: (H, W) irradiance / pi, by which it was shaded.
    """
    g.compute(
        TRACE,
        "cones.through",
        reads={
            **gb.reads(),
            "u_diffuse_gi": diffuse_gi,
            **octree.tracing_reads(),
            **sky.reads(),
        },
        writes={"u_scene_color": gb.scene_color},
        params={"View": view, **octree.params, **sky.params()},
        threads=gb.depth.size[:2],
    )
    return gb.scene_color
