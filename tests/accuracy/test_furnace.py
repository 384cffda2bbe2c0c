"""A closed white room whose walls glow converges to the limit of its geometric series.

Walls of albedo 0.9 that emit 1 end at 1 / (1 - 0.9) = 10: each gather adds nine tenths of the last
one's light. What a gather loses, the series loses many times over: 1 % of each, 8 % of the limit.
"""

# GI-07

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.scene.model import Scene
from elemental.settings import Settings
from formulas import MIRRORED_BY_ROUGH_DIELECTRIC
from gpu.rig import IDENTITY, camera, material, scene, vector
from gpu.voxel.scenes import TURNS, colored, part
from shapes import box, inward

Array = npt.NDArray[Any]

ALBEDO = 0.9
LIMIT = 1.0 + (ALBEDO - MIRRORED_BY_ROUGH_DIELECTRIC) / (1.0 - ALBEDO)
"""What the camera sees: emission and diffusely reflected light of walls that end at 10."""
SIDE_M, WALL_M = 2.0, 0.15
CAMERA = camera(vector(-0.3, 0.1, 0.4), vector(0.5, -0.2, -0.6), fov_y=1.2)
GATHERS = (2, 4, 6)
"""Evenly spaced, so that the limit of a geometric series follows from three of its sums."""
TURN = TURNS["turned"]


def room(world: Array, thick: bool) -> Scene:
    """The glowing inside of a cube: a sheet, or the inside of a black block."""
    diffuse = ALBEDO - MIRRORED_BY_ROUGH_DIELECTRIC
    glow = material(
        base_color=vector(diffuse, diffuse, diffuse, 1), emissive=vector(1, 1, 1), roughness=1.0
    )
    parts = [part(inward(box((SIDE_M,) * 3)), 0, world)]
    if thick:
        parts.append(part(box((SIDE_M + 2.0 * WALL_M,) * 3), 1, world))
    return scene(*parts, materials=[glow, colored(0.0, 0.0, 0.0)])


def radiance_after(device: Device, made: Scene, gathers: int, area_lights: bool) -> float:
    """Mean radiance of the walls as the camera sees them."""
    settings = Settings(
        {
            "gi.resolution": 64,
            "gi.bounces": gathers,
            "gi.diffuse_cones": 36,
            "gi.area_lights": area_lights,
            "gi.specular": False,
        }
    )
    renderer = Renderer(device, made, settings, (48, 36))
    try:
        picture = renderer.read(renderer.render(CAMERA, 0.0, 0, "scene_color"))
        device.finish()
        return float(picture[..., :3].mean())
    finally:
        renderer.release()


REACHED = {
    ("sheet", "straight", False): 0.95,
    ("block", "turned", False): 0.95,
    ("block", "straight", True): 0.95,
}
"""Share of the limit, by wall, turn and whether faces are area lights."""
MOST = 1.05


@pytest.mark.parametrize(("wall", "turn", "area_lights"), REACHED)
def test_a_closed_white_room_nears_the_series_limit(
    device: Device, wall: str, turn: str, area_lights: bool
) -> None:
    made = room(IDENTITY if turn == "straight" else TURN, wall == "block")
    first, second, third = (radiance_after(device, made, n, area_lights) for n in GATHERS)
    ratio = (third - second) / (second - first)
    limit = second + (third - second) / (1.0 - ratio)
    step = ratio ** (1.0 / (GATHERS[1] - GATHERS[0]))
    print(f"{wall} {turn} area {area_lights}: {limit:.3f} of {LIMIT:g}, a gather keeps {step:.4f}")
    assert 0.0 < ratio < 1.0
    assert REACHED[wall, turn, area_lights] * LIMIT <= limit <= MOST * LIMIT
    assert np.all(np.array([first, second, third]) <= MOST * LIMIT)
