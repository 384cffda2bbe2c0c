"""The highlight of a soft sphere light in rendered frames: its width and its energy. SH-03 SH-04

[Mittring12 "Soft Sphere Area Light", "Energy conserving (approximation)"]
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.scene.model import Light
from gpu.rig import IDENTITY, MakeRig, camera, material, mesh, scene, sun, vector
from shapes import quad

Array = npt.NDArray[Any]
ROUGHNESS = 0.3
POWER = 2.0 / ROUGHNESS**4 - 2.0
PLACE = vector(0.4, 3, 0)
EYE = camera(vector(-0.4, 4, 0.2), vector(0, 0, 0), fov_y=0.9)
BALANCE = 1.0 / (4.0 * np.pi**1.5 / 20.0)
"""GAUSSIAN_SPECULAR_BALANCE of glsl/lib/brdf.glsl: makes a small lobe's energy 1."""
RADII = [0.0, 0.1, 0.3, 0.8]
MIRROR = material(base_color=vector(1, 1, 1, 1), metallic=1.0, roughness=ROUGHNESS)


def lobe_angle(radius: float, distance: Array | float) -> Array:
    """acos(CosAngle) + LightAreaAngle of the slides."""
    return np.asarray(np.arccos(0.04 ** (1.0 / POWER)) + np.arctan(radius / np.asarray(distance)))


def highlight(rig: MakeRig, lamp: Light) -> tuple[Array, Array]:
    """(H, W) radiance of a mirror-like floor, and (H, W, 3) its points; all of it is specular."""
    world = scene((mesh(quad(12.0)), IDENTITY), materials=[MIRROR], lights=[lamp])
    view = rig(world, EYE, (192, 160))
    return view.scene_color()[..., 0] / BALANCE, view.positions()


def bulb(radius: float) -> Light:
    return Light("bulb", "point", vector(1, 1, 1), 9.0, PLACE, vector(0, -1, 0),
                 source_radius=radius, casts_shadow=False)  # fmt: skip


def geometry(points: Array) -> tuple[Array, Array, Array]:
    """Distance of the light, cosine to it, and half vectors (H, W, 3), in float64."""
    offset = PLACE.astype(np.float64) - points
    distance = np.linalg.norm(offset, axis=-1)
    to_light = offset / distance[..., None]
    to_eye = EYE.world_from_view[:3, 3].astype(np.float64) - points
    to_eye /= np.linalg.norm(to_eye, axis=-1, keepdims=True)
    half = to_light + to_eye
    return distance, to_light[..., 1], half / np.linalg.norm(half, axis=-1, keepdims=True)


@pytest.mark.parametrize("radius", RADII)
def test_a_highlight_is_the_slides_lobe(rig: MakeRig, radius: float) -> None:
    radiance, points = highlight(rig, bulb(radius))
    distance, cosine, half = geometry(points)
    angle = lobe_angle(radius, distance)
    norm_angle = (half[..., 1] - 1.0) / (np.cos(angle) - 1.0)
    want = 9.0 / distance**2 * np.exp(-(norm_angle**2)) * cosine / (angle**2 * 10.0)
    np.testing.assert_allclose(radiance, want, rtol=0.02, atol=2e-3 * want.max())


def test_a_highlight_is_as_wide_as_light_and_lobe_together(rig: MakeRig) -> None:
    """It falls to half where 1 - cos is 0.83 times that of the lobe's angle: exp(-x^2) = 1/2."""
    widths = []
    for radius in RADII:
        radiance, points = highlight(rig, bulb(radius))
        distance, cosine, half = geometry(points)
        lobe = radiance * distance**2 / cosine * lobe_angle(radius, distance) ** 2
        inside = np.arccos(np.clip(half[..., 1], -1, 1))[lobe > 0.5 * lobe.max()].max()
        middle = distance[np.unravel_index(lobe.argmax(), lobe.shape)]
        factor = np.sqrt(np.log(2.0))
        want = np.arccos(1.0 - factor * (1.0 - np.cos(lobe_angle(radius, middle))))
        assert inside == pytest.approx(want, rel=0.04)
        widths.append(inside)
    assert np.all(np.diff(widths) > 0.0)
    assert widths[-1] > 1.8 * widths[0]


def test_a_highlight_s_energy_does_not_depend_on_the_light_s_size(rig: MakeRig) -> None:
    """The integral over half vectors of the lobe over 10 A^2 is pi^1.5 / 20 = 0.278 for a small
    lobe angle A, whatever A is: the slide's approximation. Wide lobes lose a part of it."""
    energies = []
    for radius in RADII:
        radiance, points = highlight(rig, bulb(radius))
        distance, cosine, half = geometry(points)
        across = np.cross(np.gradient(half, axis=1), np.gradient(half, axis=0))
        solid_angle = np.linalg.norm(across, axis=-1)
        energies.append(float((radiance * distance**2 / 9.0 / cosine * solid_angle).sum()))
    constant = np.pi**1.5 / 20.0
    np.testing.assert_allclose(energies[:3], constant, rtol=0.03)
    np.testing.assert_allclose(energies[3:], constant, rtol=0.09)


def test_a_sun_s_radius_is_an_angle(rig: MakeRig) -> None:
    wide = sun(vector(-0.1, -1, 0), casts_shadow=False, source_radius=np.tan(0.2))
    sharp = sun(vector(-0.1, -1, 0), casts_shadow=False)
    peaks = [highlight(rig, light)[0].max() for light in (sharp, wide)]
    angle = float(lobe_angle(0.0, 1.0))
    assert peaks[1] / peaks[0] == pytest.approx((angle / (angle + 0.2)) ** 2, rel=0.02)


def test_the_diffuse_light_does_not_depend_on_the_size(rig: MakeRig) -> None:
    rough = material(base_color=vector(1, 1, 1, 1), roughness=1.0)
    world = [
        scene((mesh(quad(4.0)), IDENTITY), materials=[rough], lights=[bulb(radius)])
        for radius in (0.0, 0.8)
    ]
    small, large = (rig(made, EYE).scene_color()[..., 0] for made in world)
    np.testing.assert_allclose(large, small, rtol=0.04)
