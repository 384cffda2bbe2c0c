"""Depth of field by gathering circles of confusion at half the size. [Jimenez14]"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Sampled, TextureHandle
from elemental.gpu.shaders import Raster
from elemental.passes.post.scale import TRIANGLE, half_size

PREPARE = Raster(TRIANGLE, "post/dof_prepare.frag.glsl")
GATHER = Raster(TRIANGLE, "post/dof_gather.frag.glsl")
COMBINE = Raster(TRIANGLE, "post/dof_combine.frag.glsl")

CM = 0.01
SHORTEST_M = 1e-3
"""Least transition, m: a step [inferred]."""
SMALLEST_PX = 0.5
"""Radius of circles that stay inside their pixel: then nothing runs."""


def largest_radius_px(s: Mapping[str, Any], width: int) -> float:
    """Radius of the largest circle of confusion: its diameter falls with the f-stop."""
    return float(0.5 * s["dof.max_bokeh_size"] / 100.0 / s["dof.f_stop"] * width)


def focus_block(s: Mapping[str, Any], width: int) -> Block:
    """The block Focus for a picture of ``width`` px."""
    return pack(
        layouts().block("Focus"),
        distance=CM * s["dof.focal_distance"],
        per_near=1.0 / max(CM * s["dof.near_transition"], SHORTEST_M),
        per_far=1.0 / max(CM * s["dof.far_transition"], SHORTEST_M),
        largest_px=largest_radius_px(s, width),
    )


def depth_of_field(
    g: Graph, view: Block, picture: TextureHandle, depth: AnyTexture, s: Mapping[str, Any]
) -> TextureHandle:
    """Radiance (H, W) RGBA16F as a lens sees it; ``picture`` itself where that is as sharp."""
    if not s["dof.enabled"] or largest_radius_px(s, picture.width) < SMALLEST_PX:
        return picture
    focus = focus_block(s, picture.width)
    half = half_size(picture.size)
    prepared, far, near = (
        g.texture(f"dof.{name}", size=half, format=RGBA16F) for name in ("prepared", "far", "near")
    )
    g.raster(
        PREPARE,
        color=prepared,
        reads={"u_picture": picture, "u_depth": depth},
        params={"View": view, "Focus": focus},
    )
    g.raster(
        GATHER,
        color=[far, near],
        reads={"u_prepared": Sampled(prepared, "linear")},
        params={"Focus": focus},
    )
    blurred = g.texture("dof", like=picture)
    g.raster(
        COMBINE,
        color=blurred,
        reads={"u_picture": picture, "u_depth": depth, "u_far": far, "u_near": near},
        params={"View": view, "Focus": focus},
    )
    return blurred
