"""Brightness hardly depends on the octree's resolution: [docs/gi.md] has it up to 512."""

# GI-16

from __future__ import annotations

import pytest

from accuracy.resolution import SCENES, mean_luminance
from elemental.gpu.device import Device

REACHED = {"cornell_box": 0.02, "under_sky": 0.01, "atrium": 0.03}
"""Part of the brightness at 128 lattice points that 64 may be off by; the goal is 0.1."""


@pytest.mark.parametrize("name", SCENES)
def test_half_the_resolution_is_as_bright(device: Device, name: str) -> None:
    coarse, fine = (mean_luminance(device, name, resolution) for resolution in (64, 128))
    print(f"{name}: {coarse:.4f} at 64, {fine:.4f} at 128, {coarse / fine:.3f}")
    assert coarse == pytest.approx(fine, rel=REACHED[name])
