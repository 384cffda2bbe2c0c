"""Emissive faces and balls, seen through cones or in shadow maps.

[Mittring12 "Voxel Lighting": shadowed area lights from emissive materials], [Segovia06]
"""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.area_lights import ALL_MAPS, NO_MAPS, SOME_MAPS, area_maps
from elemental.passes.cone_trace.interleave import sub_image_groups, sub_images_size
from elemental.passes.gbuffer import GBuffer
from elemental.passes.shadow import ShadowMaps
from elemental.passes.voxel.octree import Octree

TRACE = {
    maps: Compute(
        "cone_trace/area_lights.comp.glsl",
        {"AREA_MAPS": maps, "SOFT_SHADOWS": int(maps != NO_MAPS)},
    )
    for maps in (NO_MAPS, SOME_MAPS, ALL_MAPS)
}
"""By which lights have shadow maps."""


def trace_area_lights(
    g: Graph, view: Block, gb: GBuffer, octree: Octree, area_lights: Block, shadows: ShadowMaps
) -> TextureHandle:
    """Nine sub-images of irradiance, each of another part of the faces, RGBA16F.

    rgb: with shadow, W/m^2; a: luminance without.
    """
    irradiance = g.texture("cones.area_lights", size=sub_images_size(gb), format=RGBA16F)
    maps = area_maps(area_lights)
    reads = {"u_depth": gb.depth, "u_gbuffer_a": gb.a, **octree.tracing_reads()}
    if maps != NO_MAPS:
        reads |= shadows.depth_reads(contact=True)
    g.compute(
        TRACE[maps],
        "cones.area_lights",
        reads=reads,
        writes={"o_irradiance": irradiance},
        params={"View": view, "AreaLights": area_lights, **octree.params},
        groups=sub_image_groups(gb),
    )
    return irradiance
