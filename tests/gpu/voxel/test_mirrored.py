# GI-07
"""A mirrored placement is lit like the plain one: its voxel normals still point outwards."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.session import Viewpoint, choose_camera
from elemental.settings import Settings
from gltf_builder import GltfBuilder
from shapes import quad

SETTINGS = Settings({"gi.resolution": 64, "shadow.resolution": 512})
VIEWPOINT = Viewpoint(None, (0.0, 1.5, 4.0), (0.0, 0.5, 0.0), 40.0)
UPRIGHT = [2**-0.5, 0, 0, 2**-0.5]


def gathered(device: Device, folder: Path, scale: list[float]) -> float:
    """Mean indirect light in a picture of a sunlit floor and wall, placed with ``scale``."""
    made = GltfBuilder()
    red, grey = made.material((0.9, 0.2, 0.2, 1)), made.material((0.8, 0.8, 0.8, 1))
    made.add(*quad(4.0), material=grey, scale=scale)
    wall = {"translation": [0, 2, -2], "rotation": UPRIGHT}
    made.add(*quad(4.0), material=red, scale=scale, **wall)
    made.light("directional", {"intensity": 3.0}, rotation=[-0.38, 0, 0, 0.92])
    scene = made.load(folder)
    renderer = Renderer(device, scene, SETTINGS, (48, 48))
    try:
        camera = choose_camera(scene, VIEWPOINT, 1.0)
        picture = renderer.read(renderer.render(camera, 0.0, 0, "diffuse_gi"))
        return float(np.mean(picture[..., :3]))
    finally:
        renderer.release()


@pytest.mark.parametrize("scale", [[-1, 1, 1], [1, 1, -1]])
def test_a_mirrored_scene_gathers_as_much(
    device: Device, tmp_path: Path, scale: list[float]
) -> None:
    plain = gathered(device, tmp_path, [1, 1, 1])
    assert plain > 0.05
    assert abs(gathered(device, tmp_path, scale) - plain) <= 0.02 * plain
