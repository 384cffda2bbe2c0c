"""Ambient occlusion of small things, from the depth buffer. [Mittring12 "SSAO sampling"]"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.formats import R8, R32F, RGBA8
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer

SSAO_VIEWS = {"ssao": "screen-space ambient occlusion, the factor on indirect light"}
"""Views of this -> help; display codes."""

SETUP = Compute("ssao/setup.comp.glsl")
OCCLUSION = Compute("ssao/occlusion.comp.glsl")
UPSAMPLE = {show: Compute("ssao/upsample.comp.glsl", defines={"SHOW": show}) for show in (0, 1)}

RADIUS_VOXELS = 2.0
"""Largest radius where cones gather: they see what is larger themselves, and hiding it twice takes
light away that the path tracer finds (docs/accuracy.md). [inferred from "Complements Voxel Lighting
with high frequency details"]"""


def occlude(
    g: Graph, view: Block, gb: GBuffer, settings: Mapping[str, Any], voxel_m: float | None = None
) -> None:
    """Multiply the ambient occlusion in `gb.b`, which direct light ignores, by the depth buffer's.

    settings: the program's, of which those named ao.* count. voxel_m: edge of the voxels, in m,
    whose light cones gather; None without them.
    """
    if settings["ao.intensity"] > 0.0:
        _occlude(g, view, gb, settings, voxel_m, None)


def ssao_view(
    g: Graph, view: Block, gb: GBuffer, settings: Mapping[str, Any], voxel_m: float | None = None
) -> TextureHandle:
    """The factor, (H, W) RGBA8 grey; black where nothing is. Arguments as for `occlude`."""
    image = g.texture("view.ssao", size=gb.depth.size, format=RGBA8)
    _occlude(g, view, gb, settings, voxel_m, image)
    return image


def _occlude(
    g: Graph,
    view: Block,
    gb: GBuffer,
    settings: Mapping[str, Any],
    voxel_m: float | None,
    image: TextureHandle | None,
) -> None:
    width, height = gb.depth.size[:2]
    half_size = (width + 1) // 2, (height + 1) // 2
    params = {"View": view, "Ssao": _params(view, half_size, settings, voxel_m)}
    half_z = g.texture("ssao.half_z", size=half_size, format=R32F)
    is_open = g.texture("ssao.open", size=half_size, format=R8)
    g.compute(
        SETUP,
        reads={"u_depth": gb.depth},
        writes={"o_half_z": half_z},
        params=params,
        threads=half_size,
    )
    g.compute(
        OCCLUSION,
        reads={"u_half_z": half_z, "u_gbuffer_a": gb.a},
        writes={"o_open": is_open},
        params=params,
        threads=half_size,
    )
    reads: dict[str, Ref] = {"u_half_z": half_z, "u_open": is_open, "u_gbuffer_a": gb.a}
    g.compute(
        UPSAMPLE[int(image is not None)],
        reads={**reads, "u_depth": gb.depth},
        writes={"u_gbuffer_b": gb.b} if image is None else {"o_image": image},
        params=params,
        threads=(width, height),
    )


def _params(
    view: Block, half_size: tuple[int, int], settings: Mapping[str, Any], voxel_m: float | None
) -> Block:
    largest = math.inf if voxel_m is None else RADIUS_VOXELS * voxel_m
    clip_from_world, world_from_view = (
        np.asarray(view[name], np.float64).T for name in ("clip_from_world", "world_from_view")
    )
    clip_from_view = clip_from_world @ world_from_view
    return pack(
        layouts().block("Ssao"),
        view_ray=(1.0 / clip_from_view[0, 0], 1.0 / clip_from_view[1, 1]),
        half_size=half_size,
        radius=min(settings["ao.radius"], largest),
        bias=settings["ao.bias"],
        intensity=settings["ao.intensity"],
        power=settings["ao.power"],
        fade_end=settings["ao.fade_distance"],
        fade_range=settings["ao.fade_radius"],
    )
