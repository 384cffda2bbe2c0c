"""What becomes of the G-buffer between drawing and light: docs/surfaces.md."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from elemental.core.layout import Block
from elemental.gpu.graph import Graph
from elemental.passes.gbuffer import GBuffer
from elemental.passes.gbuffer_blur import blur_gbuffer
from elemental.passes.ssao import occlude


def settle_surfaces(
    g: Graph, view: Block, gb: GBuffer, settings: Mapping[str, Any], voxel_m: float | None
) -> GBuffer:
    """The G-buffer that cones and lights read: occluded in screen space, then blurred.

    voxel_m: edge of the voxels in m; None without indirect light, which alone is occluded.
    """
    if voxel_m is not None:
        occlude(g, view, gb, settings, voxel_m)
    return blur_gbuffer(g, view, gb) if settings["gbuffer.blur"] else gb
