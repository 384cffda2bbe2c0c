"""Light among regions of several leaf levels: as where all have one. GI-01, GI-06, GI-11"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.scene.model import Region
from elemental.session import open_scene

Array = npt.NDArray[Any]
SIZE = (48, 48)
MOST_OFF = 0.02
"""Of the picture's light; 0.11 where cones start by the finest lattice everywhere."""
MOST_OFF_P90 = 0.15
"""Of a pixel's; 0.39 by the finest lattice."""


def picture(device: Device, resolution: int, *regions: Region) -> Array:
    """(H, W, 3) float64 radiance of the Cornell box."""
    scene, settings = open_scene(
        "cornell_box", (f"gi.resolution={resolution}", "gi.bounces=2", "gi.diffuse_pattern=3")
    )
    scene.regions = list(regions)
    renderer = Renderer(device, scene, settings, SIZE)
    eye = scene.default_camera(1.0)
    renderer.render(eye, 0.0, 0, "scene_color")
    device.finish()
    shown = renderer.read(renderer.render(eye, 0.0, 1, "scene_color"))[..., :3]
    renderer.release()
    return shown.astype(np.float64)


@pytest.mark.parametrize(("resolution", "offset"), [(64, 2), (128, -1)])
def test_a_region_of_another_level_leaves_the_light_as_it_is(
    device: Device, resolution: int, offset: int
) -> None:
    scene, _ = open_scene("cornell_box", ())
    low, high = scene.bounds()
    middle = (low + high) / 2
    corner = Region(low.astype(np.float32), middle.astype(np.float32), offset)
    uniform = picture(device, resolution)
    divided = picture(device, resolution, corner)
    lit = uniform.sum(axis=2) < 10.0  # not the lamp
    ratio = divided[lit].sum() / uniform[lit].sum()
    errors = np.abs(divided[lit] - uniform[lit]).sum(axis=1) / uniform[lit].sum(axis=1).clip(1e-3)
    print(f"{resolution} {offset:+d}: {ratio:.3f}, p90 {np.percentile(errors, 90):.3f}")
    assert abs(ratio - 1.0) < MOST_OFF
    assert np.percentile(errors, 90) < MOST_OFF_P90
