"""Light among regions of several leaf levels: as where all have one. GI-01, GI-06, GI-11"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
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
"""Of the picture's light; 0.1 where cones start and step by the finest lattice everywhere."""
MOST_OFF_BESIDE = 0.035
"""Of the light beside a border of the regions; 0.06 to 0.21 by the finest lattice."""
MOST_OFF_P90 = 0.15
"""Of a pixel's; 0.4 by the finest lattice."""
LAMP = 10.0
"""Sum of its radiance; no wall is as bright."""
BORDER_PX = 2
"""How far from where the levels meet a pixel is beside it."""


def picture(device: Device, resolution: int, bounces: int, offset: int = 0) -> tuple[Array, Array]:
    """(H, W, 3) float64 radiance of the Cornell box, an eighth of which has leaves of another
    level, and (H, W) bool: beside the border of that part."""
    words = (f"gi.resolution={resolution}", f"gi.bounces={bounces}", "gi.diffuse_pattern=3")
    scene, settings = open_scene("cornell_box", words)
    low, high = scene.bounds()
    corner = Region(low.astype(np.float32), (0.5 * (low + high)).astype(np.float32), offset)
    scene.regions = [corner] if offset else []
    renderer = Renderer(device, scene, settings, SIZE)
    eye = scene.default_camera(1.0)
    renderer.render(eye, 0.0, 0, "scene_color")
    device.finish()
    shown = renderer.read(renderer.render(eye, 0.0, 1, "scene_color"))[..., :3]
    levels = renderer.read(renderer.render(eye, 0.0, 2, "regions"))[..., :3]
    renderer.release()
    return shown.astype(np.float64), beside_border(levels.astype(np.float64))


def beside_border(levels: Array) -> Array:
    """(H, W) bool, of the view of the regions, whose levels differ in hue, not in brightness."""
    hue = levels / np.linalg.norm(levels, axis=2, keepdims=True).clip(1e-6)
    border = np.zeros(levels.shape[:2], np.bool_)
    border[:, 1:] |= np.abs(np.diff(hue, axis=1)).max(axis=2) > 0.1
    border[1:] |= np.abs(np.diff(hue, axis=0)).max(axis=2) > 0.1
    reach = range(-BORDER_PX, BORDER_PX + 1)
    return np.any([np.roll(border, (x, y), (1, 0)) for x in reach for y in reach], axis=0)


@pytest.fixture(scope="module")
def uniform(device: Device) -> Callable[[int, int], Array]:
    """Pictures without regions, by resolution and gathers."""
    return cache(lambda resolution, bounces: picture(device, resolution, bounces)[0])


@pytest.mark.parametrize(
    ("resolution", "bounces", "offset"), [(64, 2, 2), (64, 2, -1), (128, 1, -2)]
)
def test_a_region_of_another_level_leaves_the_light_as_it_is(
    device: Device,
    uniform: Callable[[int, int], Array],
    resolution: int,
    bounces: int,
    offset: int,
) -> None:
    plain = uniform(resolution, bounces)
    divided, beside = picture(device, resolution, bounces, offset)
    lit = plain.sum(axis=2) < LAMP
    assert (lit & beside).mean() > 0.1
    for place, most_off in ((lit, MOST_OFF), (lit & beside, MOST_OFF_BESIDE)):
        ratio = divided[place].sum() / plain[place].sum()
        errors = np.abs(divided - plain)[place].sum(axis=1)
        p90 = np.percentile(errors / plain[place].sum(axis=1).clip(1e-3), 90)
        print(f"{resolution} {offset:+d}: {ratio:.3f}, p90 {p90:.3f} of {place.sum()} pixels")
        assert abs(ratio - 1.0) < most_off
        assert p90 < MOST_OFF_P90
