"""Deferred shading: direct light by the talk's formulas, indirect light as it arrives."""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer
from elemental.passes.light_cells import ALL_LIGHTS, NO_CELLS, VIEW_CELLS, LightCells
from elemental.passes.shadow import ShadowMaps
from elemental.passes.sky import Sky

SHADER = "shade/shade.comp.glsl"
VARIANTS = {
    (sky, diffuse, specular, cells): Compute(
        SHADER,
        {"SKY": sky, "DIFFUSE_GI": diffuse, "SPECULAR_GI": specular, "LIGHT_CELLS": cells},
    )
    for sky in (0, 1)
    for diffuse in (0, 1)
    for specular in (0, 1)
    for cells in (ALL_LIGHTS, VIEW_CELLS)
}


def shade(
    g: Graph,
    view: Block,
    gb: GBuffer,
    shadows: ShadowMaps,
    *,
    cells: LightCells = NO_CELLS,
    sky: Sky | None = None,
    diffuse_gi: TextureHandle | None = None,
    specular_gi: TextureHandle | None = None,
) -> TextureHandle:
    """Scene-referred radiance, (H, W) RGBA16F: `gb.scene_color` with light added in place.

    diffuse_gi: irradiance / pi; specular_gi: radiance along the mirrored eye ray; without them
    there is no indirect light. cells: of `cull_to_view`. sky: drawn behind the scene, black
    without it.
    """
    reads: dict[str, Ref] = {**gb.reads(), **shadows.light_reads(), **cells.reads()}
    params = {"View": view, **shadows.params(), **cells.params()}
    if sky is not None:
        reads |= sky.reads()
        params |= sky.params()
    if diffuse_gi is not None:
        reads["u_diffuse_gi"] = diffuse_gi
    if specular_gi is not None:
        reads["u_specular_gi"] = specular_gi
    given = (int(sky is not None), int(diffuse_gi is not None), int(specular_gi is not None))
    g.compute(
        VARIANTS[*given, cells.kind],
        reads=reads,
        writes={"u_scene_color": gb.scene_color},
        params=params,
        threads=gb.depth.size,
    )
    return gb.scene_color
