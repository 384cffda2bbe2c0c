"""Emissive faces and balls seen through cones. [Mittring12 "Voxel Lighting": shadowed area lights
from emissive materials], [Segovia06]"""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.cone_trace.interleave import sub_image_groups, sub_images_size
from elemental.passes.gbuffer import GBuffer
from elemental.passes.voxel.octree import Octree

TRACE = Compute("cone_trace/area_lights.comp.glsl")


def trace_area_lights(
    g: Graph, view: Block, gb: GBuffer, octree: Octree, area_lights: Block
) -> TextureHandle:
    """Nine sub-images of irradiance, each of another part of the faces, RGBA16F.

    rgb: with shadow, W/m^2; a: luminance without.
    """
    irradiance = g.texture("cones.area_lights", size=sub_images_size(gb), format=RGBA16F)
    g.compute(
        TRACE,
        "cones.area_lights",
        reads={"u_depth": gb.depth, "u_gbuffer_a": gb.a, **octree.tracing_reads()},
        writes={"o_irradiance": irradiance},
        params={"View": view, "AreaLights": area_lights, **octree.params},
        groups=sub_image_groups(gb),
    )
    return irradiance
