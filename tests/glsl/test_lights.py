"""Punctual lights against the formulas of KHR_lights_punctual, profiles and masks. SH-09"""

from __future__ import annotations

import numpy as np
import pytest

from elemental.core.images import resized
from elemental.core.layout import Block
from elemental.gpu.device import Device
from elemental.passes.light_pack import pack_lights
from elemental.passes.light_shapes import MASK_SIZE, LightShapes, shapes_of
from elemental.scene.ies import LightProfile
from elemental.scene.light_masks import drifted
from elemental.scene.lights import Light, LightMask
from glsl.harness import run_glsl


def light(kind: str, **fields: object) -> Light:
    given = {
        "name": kind,
        "kind": kind,
        "color": np.array([1.0, 0.5, 0.25], np.float32),
        "intensity": 8.0,
        "position": np.array([1.0, 2.0, 3.0], np.float32),
        "direction": np.array([0.0, 0.0, -1.0], np.float32),
        **fields,
    }
    return Light(**given)  # type: ignore[arg-type]


def irradiance(device: Device, source: Light, points: np.ndarray) -> np.ndarray:
    packed: Block = pack_lights([source], [-1], [(0, 0)])
    lights = device.buffer("lights", packed)
    profiles = LightShapes(device)
    profiles.update(shapes_of([source]))
    body, reads = (
        "sample_light(lights[0], p, 0.0).irradiance",
        {"Lights": lights, **profiles.reads()},
    )
    values = run_glsl(device, ["lib/lights.glsl"], body, {"p": points}, "vec3", reads=reads)
    profiles.release()
    lights.release()
    return values


def test_a_directional_light_is_its_illuminance_everywhere(device: Device) -> None:
    points = np.random.default_rng(1).normal(size=(16, 3))
    got = irradiance(device, light("directional"), points)
    np.testing.assert_allclose(got, np.tile([8.0, 4.0, 2.0], (16, 1)), rtol=1e-6)


def test_a_point_light_falls_with_the_square_of_the_distance(device: Device) -> None:
    distance = np.linspace(0.1, 20, 50)
    points = np.array([1.0, 2.0, 3.0]) + distance[:, None] * [0.6, 0.0, 0.8]
    got = irradiance(device, light("point"), points)
    np.testing.assert_allclose(got[:, 0], 8.0 / distance**2, rtol=1e-5)


def test_range_windows_the_light_as_the_extension_says(device: Device) -> None:
    """attenuation = max(min(1 - (d / range)^4, 1), 0) / d^2"""
    distance = np.linspace(0.1, 8, 80)
    points = np.array([1.0, 2.0, 3.0]) + distance[:, None] * [0.0, 1.0, 0.0]
    got = irradiance(device, light("point", range=5.0), points)
    want = 8.0 * np.clip(1 - (distance / 5.0) ** 4, 0, 1) / distance**2
    np.testing.assert_allclose(got[:, 0], want, rtol=1e-4, atol=1e-6)
    assert np.all(got[distance >= 5.0] == 0.0)


def test_a_spot_s_edges_are_its_two_angles(device: Device) -> None:
    inner, outer = 0.3, 0.6
    angle = np.linspace(0.0, 1.0, 101)
    points = np.array([1.0, 2.0, 3.0]) + np.stack(
        [2 * np.sin(angle), np.zeros(101), -2 * np.cos(angle)], axis=1
    )
    got = irradiance(device, light("spot", inner_angle=inner, outer_angle=outer), points)
    scale = 1.0 / max(0.001, np.cos(inner) - np.cos(outer))
    want = np.clip(np.cos(angle) * scale - np.cos(outer) * scale, 0, 1) ** 2 * 8.0 / 4.0
    np.testing.assert_allclose(got[:, 0], want, rtol=2e-4, atol=1e-5)
    np.testing.assert_allclose(got[angle < inner - 1e-6, 0], 2.0, rtol=1e-4)
    assert np.all(got[angle > outer + 1e-3] == 0.0)


def picture(seed: int, side: int = 16) -> LightMask:
    """Coloured noise."""
    return LightMask("noise", np.random.default_rng(seed).random((side, side, 3)).astype("f4"))


def looked_up(mask: LightMask, uv: np.ndarray) -> np.ndarray:
    """Bilinear, repeating; u to the right, v down from the picture's top."""
    pixels = resized(mask.pixels, *MASK_SIZE)
    place = uv * MASK_SIZE[0] - 0.5
    low = np.floor(place).astype(int)
    t = (place - low)[:, :, None]
    at = [
        [pixels[(low[:, 1] + dy) % 256, (low[:, 0] + dx) % 256] for dx in (0, 1)] for dy in (0, 1)
    ]
    rows = [row[0] * (1 - t[:, 0]) + row[1] * t[:, 0] for row in at]
    return rows[0] * (1 - t[:, 1]) + rows[1] * t[:, 1]


@pytest.mark.parametrize("kind", ["spot", "directional"])
def test_a_mask_is_projected_upright_for_who_looks_along_the_light(
    device: Device, kind: str
) -> None:
    """Over a spot's cone, beyond it nothing; of a sun every `mask_size` m, moved as it scrolls."""
    rng, outer = np.random.default_rng(2), 0.6
    place = {"mask_size": 1.5, "mask_scroll": (0.25, -0.5)} if kind == "directional" else {}
    source = light(kind, mask=picture(1), outer_angle=outer, inner_angle=outer, **place)
    x, y = rng.uniform(-1.2, 1.2, (2, 800))  # right and up for who looks along -z
    points = source.position + np.stack([x, y, np.full(800, -2.0)], axis=1)
    if kind == "spot":
        wide = 2.0 * np.tan(outer)
        uv = np.stack([0.5 + 0.5 * x / wide, 0.5 - 0.5 * y / wide], axis=1)
        plain = irradiance(device, light(kind, outer_angle=outer, inner_angle=outer), points)
        got = irradiance(device, source, points)
        assert (got[:, 0] == 0.0).any()
    else:
        source = drifted(source, 0.5)
        uv = np.stack([x / 1.5 + 0.5 - 0.125, -y / 1.5 + 0.5 + 0.25], axis=1)
        plain = np.tile([8.0, 4.0, 2.0], (800, 1))
        got = irradiance(device, source, points)
    np.testing.assert_allclose(got, plain * looked_up(source.mask, uv), rtol=0.01, atol=0.01)


def test_a_wide_place_sees_the_masks_mean(device: Device) -> None:
    """Voxels are lit by the mean of the mask over their width; here by all of it."""
    mask = picture(3)
    source = light("directional", mask=mask, mask_size=0.01)
    packed = device.buffer("lights", pack_lights([source], [-1], [(0, 0)]))
    profiles = LightShapes(device)
    profiles.update(shapes_of([source]))
    points = np.random.default_rng(5).normal(size=(32, 3))
    got = run_glsl(
        device, ["lib/lights.glsl"],
        "sample_light(lights[0], p, 0.01).irradiance",
        {"p": points}, "vec3", reads={"Lights": packed, **profiles.reads()},
    )  # fmt: skip
    np.testing.assert_allclose(got, np.tile([8.0, 4.0, 2.0] * mask.pixels.mean((0, 1)), (32, 1)),
                               rtol=0.01)  # fmt: skip
    profiles.release()
    packed.release()


def test_a_profile_scales_the_intensity_by_its_direction(device: Device) -> None:
    """Against the file's own angles, for a luminaire that is turned every way."""
    vertical = np.radians(np.arange(0, 181, 10.0))
    horizontal = np.radians(np.arange(0, 361, 30.0))
    v, h = np.meshgrid(vertical, horizontal)
    candela = 100.0 + 60.0 * np.cos(2.0 * v) + 30.0 * np.sin(v) * np.cos(h + 0.4)
    profile = LightProfile("test", vertical, horizontal, candela)
    direction = np.array([0.48, -0.6, 0.64], np.float32)
    source = light("point", profile=profile, roll=0.7, direction=direction)
    axis = source.profile_axis.astype(np.float64)
    across = np.cross(direction, axis)
    rng = np.random.default_rng(4)
    away = rng.normal(size=(2000, 3))
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    away = away[np.abs(away @ direction) < 0.98]  # where the planes are not all one
    got = irradiance(device, source, source.position + 2.0 * away)[:, 0]
    down, turned = np.arccos(away @ direction), np.arctan2(away @ across, away @ axis)
    want = 8.0 / 4.0 * profile.intensity(down, turned) / profile.peak
    np.testing.assert_allclose(got, want, atol=0.01 * want.max())
    assert want.min() < 0.5 * want.max()
