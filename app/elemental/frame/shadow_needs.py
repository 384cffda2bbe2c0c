"""What shadow maps are made for and how far lights reach, as settings and volumes have it."""

from __future__ import annotations

import math
from collections.abc import Sequence

from elemental.passes.shadow_plan import ShadowSettings
from elemental.scene.volumes import Volume
from elemental.settings import Settings

SHADOW_KEYS = frozenset(
    f"shadow.{name}" for name in ("resolution", "cascades", "distance", "budget", "penumbras")
) | {"lights.culling"}
"""Settings that the shadow maps are made for."""


def shadow_settings(settings: Settings, volumes: Sequence[Volume]) -> ShadowSettings:
    """Of the maps of a scene with these volumes."""
    return ShadowSettings(
        resolution=settings["shadow.resolution"],
        cascades=settings["shadow.cascades"],
        reach=settings["shadow.distance"],
        budget=settings["shadow.budget"],
        penumbras=settings["shadow.penumbras"],
        culling=settings["lights.culling"],
        cutoff=cutoff(settings, volumes),
    )


def cutoff(settings: Settings, volumes: Sequence[Volume]) -> float:
    """Irradiance, lux, at which lights without a range end: darker where the picture is developed
    brighter. Of the brightest that any place sees, and in whole stops, since voxels are lit anew
    for each change."""
    exposures = [v.overrides["exposure"] for v in volumes if v.acts and "exposure" in v.overrides]
    brightest = max([settings["exposure"], *exposures])
    return float(settings["lights.cutoff"] / 2.0 ** math.ceil(brightest))
