"""Deferred shading: direct light by the talk's formulas, indirect light as it arrives."""

from __future__ import annotations

from collections.abc import Collection

from elemental.core.layout import Block
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Ref, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer
from elemental.passes.light_cells import ALL_LIGHTS, NO_CELLS, VIEW_CELLS, LightCells
from elemental.passes.material_table import models_mask
from elemental.passes.shadow import ShadowMaps
from elemental.passes.sky import Sky
from elemental.scene.definitions import LIGHTING_MODELS

SHADER = "shade/shade.comp.glsl"
PLAIN, EVERY = models_mask(()), models_mask(LIGHTING_MODELS)
"""LIGHTING_MODELS: where no material asks for more than the default one, and where any does."""
VARIANTS = {
    (sky, diffuse, specular, cells, models, soft): Compute(
        SHADER,
        {
            "SKY": sky,
            "DIFFUSE_GI": diffuse,
            "SPECULAR_GI": specular,
            "LIGHT_CELLS": cells,
            "LIGHTING_MODELS": models,
            "SOFT_SHADOWS": soft,
            "CONTACT_SHADOWS": 1,
        },
    )
    for sky in (0, 1)
    for diffuse in (0, 1)
    for specular in (0, 1)
    for cells in (ALL_LIGHTS, VIEW_CELLS)
    for models in (PLAIN, EVERY)
    for soft in (0, 1)
}


def shade(
    g: Graph,
    view: Block,
    gb: GBuffer,
    shadows: ShadowMaps,
    *,
    cells: LightCells = NO_CELLS,
    models: Collection[str] = LIGHTING_MODELS,
    sky: Sky | None = None,
    diffuse_gi: AnyTexture | None = None,
    specular_gi: AnyTexture | None = None,
) -> TextureHandle:
    """Scene-referred radiance, (H, W) RGBA16F: `gb.scene_color` with light added in place.

    diffuse_gi: irradiance / pi; specular_gi: radiance along the mirrored eye ray; without them
    there is no indirect light. cells: of `cull_to_view`. models: the lighting models that
    there may be beyond the default one. sky: drawn behind the scene, black without it.
    """
    reads: dict[str, Ref] = {**gb.reads(), **shadows.view_reads(contact=True), **cells.reads()}
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
        VARIANTS[*given, cells.kind, EVERY if models else PLAIN, int(shadows.soft)],
        reads=reads,
        writes={"u_scene_color": gb.scene_color},
        params=params,
        threads=gb.depth.size,
    )
    return gb.scene_color
