"""Indirect glossy light. [Mittring12 "Specular Sampling 1/2", "2/2"]"""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer
from elemental.passes.sky import Sky
from elemental.passes.voxel.octree import Octree

SELECT = Compute("cone_trace/specular_select.comp.glsl")
TRACE = Compute("cone_trace/specular.comp.glsl")
LIST_HEADER_BYTES = 16
"""Group counts and item count of SpecularList."""


def trace_specular(
    g: Graph,
    view: Block,
    gb: GBuffer,
    octree: Octree,
    sky: Sky,
    area_lights: Block,
    diffuse_gi: TextureHandle,
) -> TextureHandle:
    """Radiance along the mirrored eye vector, (H, W) RGBA16F; a: visibility of the sky.

    The cone is as wide as the surface's specular lobe; a broad lobe on a dim surface takes what the
    diffuse cones gathered. The pixels that are traced are listed first and dispatched indirectly,
    so that every thread has a cone.
    """
    width, height = gb.depth.size[:2]
    specular = g.texture("specular_gi", like=gb.depth, format=RGBA16F)
    pixels = g.buffer("specular_list", LIST_HEADER_BYTES + 4 * width * height)
    g.clear_buffer(pixels, 0, size=LIST_HEADER_BYTES)
    g.clear_buffer(pixels, 1, offset=4, size=8)
    surface: dict[str, Ref] = {"u_depth": gb.depth, "u_gbuffer_d": gb.d}
    g.compute(
        SELECT,
        "cones.specular_select",
        reads={**surface, "u_gbuffer_b": gb.b, "u_diffuse_gi": diffuse_gi},
        writes={"o_specular_gi": specular, "SpecularList": pixels},
        params={"View": view},
        threads=(width, height),
    )
    g.compute(
        TRACE,
        "cones.specular",
        reads={**surface, "u_gbuffer_a": gb.a, **octree.tracing_reads(), **sky.reads()},
        writes={"o_specular_gi": specular, "SpecularList": pixels},
        params={"View": view, "AreaLights": area_lights, **octree.params, **sky.params()},
        indirect=(pixels, 0),
    )
    return specular
