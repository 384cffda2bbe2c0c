# PP-11
"""Factors on indirect and on the environment's light: linear, on surfaces alone, by volumes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.scene.model import Environment
from elemental.scene.volumes import Volume
from elemental.settings import Settings
from gpu.rig import IDENTITY, at, camera, material, mesh, scene, sun, vector
from shapes import box, quad

Array = npt.NDArray[Any]
SIZE = (48, 32)
HALF_STEP = 2.0**-10
"""Relative rounding of one 16-bit float; a pixel is stored a few times on its way."""


@pytest.fixture
def renderer(device: Device) -> Iterator[Renderer]:
    """A box on a floor under a coloured sky and a sun, the floor's far part against the sky."""
    made = scene(
        (mesh(quad(4.0)), IDENTITY),
        (mesh(box((0.8, 0.8, 0.8))), at(0.0, 0.4, 0.0)),
        materials=[material(roughness=0.4)],
        lights=[sun(vector(-0.4, -1.0, -0.3))],
        environment=Environment(None, vector(0.3, 0.6, 1.0), 1.0),
    )
    exact = {"gi.specular_adaptive": False}  # interpolation where neighbours agree is not linear
    settings = Settings({"gi.resolution": 64, "shadow.resolution": 256, **exact})
    renderer = Renderer(device, made, settings, SIZE)
    yield renderer
    renderer.release()


EYE = camera(vector(0.0, 1.2, 4.0), vector(0.0, 0.6, 0.0))


def picture(renderer: Renderer, **values: Any) -> Array:
    """(H, W, 4) radiance with some settings set; `a__b` stands for the key a.b."""
    renderer.settings = renderer.settings.replace(
        {k.replace("__", "."): v for k, v in values.items()}
    )
    return renderer.read(renderer.render(EYE, 0.0, 0, "scene_color")).astype(np.float64)


def test_indirect_light_scales_by_intensity_and_colour(renderer: Renderer) -> None:
    direct = picture(renderer, indirect__intensity=0.0)
    unit = picture(renderer, indirect__intensity=1.0)
    doubled = picture(renderer, indirect__intensity=2.0)
    tinted = picture(renderer, indirect__intensity=1.0, indirect__color=(1.0, 0.5, 0.0))
    without = picture(renderer, gi__enabled=False)
    assert np.array_equal(direct, without)
    indirect = unit - direct
    assert indirect[..., :3].max() > 0.1
    allowed = 4 * HALF_STEP * (doubled[..., :3] + 1e-3)
    assert (np.abs(doubled - direct - 2 * indirect)[..., :3] <= allowed).all()
    shares = (tinted - direct)[..., :3] - indirect[..., :3] * (1.0, 0.5, 0.0)
    assert (np.abs(shares) <= allowed).all()


def test_the_environment_lights_surfaces_by_its_factor_and_shows_unchanged(
    renderer: Renderer,
) -> None:
    unit = picture(renderer)
    red = picture(renderer, ambient_cubemap__tint=(1.0, 0.0, 0.0))
    halved = picture(
        renderer, ambient_cubemap__tint=(1.0, 1.0, 1.0), ambient_cubemap__intensity=0.5
    )
    dark = picture(renderer, ambient_cubemap__intensity=0.0)
    sky = unit[..., 3] == 0.0
    assert sky.any()
    assert not sky.all()
    for other in (red, halved, dark):
        assert np.array_equal(other[sky], unit[sky])
    assert np.array_equal(red[..., 1:3], dark[..., 1:3])
    assert (unit - dark)[..., :3].max() > 0.1
    middle = (unit + dark) / 2
    assert (np.abs(halved - middle)[..., :3] <= 4 * HALF_STEP * (unit[..., :3] + 1e-3)).all()


def test_a_volume_overrides_what_its_frame_shows(renderer: Renderer) -> None:
    direct = picture(renderer, indirect__intensity=0.0)
    doubled = picture(renderer, indirect__intensity=2.0)
    plain = picture(renderer, indirect__intensity=1.0)
    around = Volume("v", center=(0.0, 1.2, 4.0), overrides={"indirect.intensity": 2.0})
    for volumes, expected in (
        ([around], doubled),
        ([replace(around, center=(0.0, 0.0, 50.0))], plain),
        ([around, replace(around, overrides={"indirect.intensity": 0.0}, priority=1.0)], direct),
    ):
        renderer.scene.volumes = volumes
        assert np.array_equal(picture(renderer), expected)
