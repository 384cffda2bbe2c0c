"""How bright the scenes of the ratchet are at other resolutions of the octree."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from accuracy.ratchet import CASES, draw, read_reference
from elemental.gpu.device import Device
from reference.metrics import LUMINANCE

SCENES = ("cornell_box", "under_sky", "atrium")
GATHERS = 2
"""Enough for light to pass through voxels twice, few enough for 512 lattice points a side."""


def mean_luminance(device: Device, name: str, resolution: int) -> float:
    """Mean luminance of `scene_color` where the eye meets neither an emitter nor the sky."""
    case = CASES[name]
    words = (*case.settings, f"gi.resolution={resolution}", f"gi.bounces={GATHERS}")
    picture = draw(device, replace(case, settings=words))
    _, mask = read_reference(case.file)
    return float(np.mean((picture @ LUMINANCE)[mask > 0.0], dtype=np.float64))
