"""Pictures of what the frame computes on its way."""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA8, RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer
from elemental.passes.light_cells import ALL_LIGHTS, NO_CELLS, VIEW_CELLS, LightCells
from elemental.passes.shadow import ShadowMaps

CHANNELS = {
    "normal": "world normal, -1..1 as 0..1",
    "diffuse": "diffuse colour",
    "specular": "specular colour",
    "specular_power": "specular power by its code, false colour: white is sharpest",
    "ao": "the material's ambient occlusion",
    "depth": "distance, logarithmic, false colour: white is the near plane",
    "lighting_model": "lighting model: black unlit, violet default, orange subsurface, white cloth",
    "subsurface": "subsurface colour",
    "decal_mask": "share of a decal that a surface takes on",
}
"""Views of one G-buffer channel -> help; display codes."""

LIGHT_VIEWS = {
    "shadow": "share of the lights' irradiance that arrives; black in shadow, and where no light "
    "faces the surface",
    "direct": "radiance by direct light alone",
}
"""Views of the lights -> help; linear."""

SURFACE = {
    name: Compute("views/surface.comp.glsl", defines={"CHANNEL": f"CHANNEL_{name.upper()}"})
    for name in CHANNELS
}
LIGHTS = {
    (name, cells, soft): Compute(
        "views/lights.comp.glsl",
        {
            "SHOW_RADIANCE": int(name == "direct"),
            "LIGHT_CELLS": cells,
            "SOFT_SHADOWS": soft,
            "CONTACT_SHADOWS": 1,
        },
    )
    for name in LIGHT_VIEWS
    for cells in (ALL_LIGHTS, VIEW_CELLS)
    for soft in (0, 1)
}


def surface_view(g: Graph, view: Block, gb: GBuffer, name: str) -> TextureHandle:
    """One of CHANNELS as a picture, (H, W) RGBA8 display codes; black where nothing is."""
    image = g.texture(f"view.{name}", size=gb.depth.size, format=RGBA8)
    g.compute(
        SURFACE[name],
        f"view.{name}",
        reads=gb.reads(),
        writes={"o_image": image},
        params={"View": view},
        threads=image.size,
    )
    return image


def light_view(
    g: Graph,
    view: Block,
    gb: GBuffer,
    shadows: ShadowMaps,
    name: str,
    cells: LightCells = NO_CELLS,
) -> TextureHandle:
    """One of LIGHT_VIEWS, (H, W) RGBA16F linear."""
    image = g.texture(f"view.{name}", size=gb.depth.size, format=RGBA16F)
    g.compute(
        LIGHTS[name, cells.kind, int(shadows.soft)],
        f"view.{name}",
        reads={**gb.reads(), **shadows.view_reads(contact=True), **cells.reads()},
        writes={"o_image": image},
        params={"View": view, **shadows.params(), **cells.params()},
        threads=image.size,
    )
    return image
