"""What may be looked at: the finished picture, and what passes make on the way to it."""

from __future__ import annotations

from collections.abc import Mapping

from elemental.passes.cone_trace.steps import STEP_VIEWS
from elemental.passes.ssao import SSAO_VIEWS
from elemental.passes.views import CHANNELS, LIGHT_VIEWS
from elemental.passes.voxel.view import VOXEL_VIEWS

VIEWS: Mapping[str, str] = {
    "final": "the finished picture",
    "scene_color": "scene-referred linear radiance: no exposure, no post",
    **CHANNELS,
    **SSAO_VIEWS,
    **LIGHT_VIEWS,
    "diffuse_gi": "indirect irradiance / pi, linear",
    "specular_gi": "indirect radiance along the mirrored eye vector, linear",
    "specular_traced": "specular cones, false colour: interpolated, traced first, traced",
    **STEP_VIEWS,
    **VOXEL_VIEWS,
}
"""View name -> help."""

LINEAR_VIEWS = frozenset({"scene_color", "diffuse_gi", "specular_gi", "voxels", *LIGHT_VIEWS})
SPECULAR_VIEWS = frozenset({"specular_gi", "specular_traced"})
HELD_VIEWS = frozenset({"final", "scene_color"})
"""Views whose gathered light is held while they stand."""
OCTREE_VIEWS = frozenset({"diffuse_gi", *SPECULAR_VIEWS, *STEP_VIEWS, *VOXEL_VIEWS})
