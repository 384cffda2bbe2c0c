"""FXAA on pictures with known answers. PP-10"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8
from elemental.passes.post.fxaa import fxaa
from gpu.rig import read

Array = npt.NDArray[Any]


def smoothed(device: Device, pixels: Array) -> Array:
    """(H, W, 4) uint8 display codes after the filter; rows stay in their order."""
    height, width = pixels.shape[:2]
    source = device.texture("source", (width, height), RGBA8, data=pixels)
    g = device.begin_frame()
    result = read(g, fxaa(g, source))[::-1].copy()
    source.release()
    return result


def test_fxaa_leaves_flat_and_soft_areas_bit_identical(device: Device) -> None:
    rng = np.random.default_rng(4)
    flat = np.full((48, 64, 4), 255, np.uint8)
    flat[..., :3] = rng.integers(118, 122, (48, 64, 3))
    np.testing.assert_array_equal(smoothed(device, flat), flat)


def test_fxaa_leaves_straight_edges_sharp(device: Device) -> None:
    """A long edge along the pixels has nothing to smooth but its own end."""
    pixels = np.full((40, 64, 4), 255, np.uint8)
    pixels[:20, :, :3] = 30
    got = smoothed(device, pixels)
    assert np.abs(got[:, 24:40].astype(int) - pixels[:, 24:40]).max() <= 26


def slanted_edge(slope: float, vertical: bool) -> tuple[Array, Array]:
    """(aliased picture, coverage 0..1) of a half plane under a slightly tilted edge."""
    y, x = np.mgrid[0:48, 0:64]
    edge = 20.0 + slope * (x + 0.5)
    picture = np.where((y + 0.5)[..., None] > edge[..., None], 230.0, 25.0)
    coverage = np.clip(y + 1.0 - edge, 0, 1)
    pixels = np.full((48, 64, 4), 255, np.uint8)
    pixels[..., :3] = picture
    if vertical:
        return np.ascontiguousarray(pixels.transpose(1, 0, 2)), coverage.T
    return pixels, coverage


@pytest.mark.parametrize("vertical", [False, True])
@pytest.mark.parametrize("slope", [0.125, -0.2, 0.3])
def test_fxaa_smooths_a_slanted_edge_towards_its_coverage(
    device: Device, slope: float, vertical: bool
) -> None:
    pixels, coverage = slanted_edge(slope, vertical)
    got = smoothed(device, pixels)[..., 0].astype(float)
    ideal = 25 + 205 * coverage
    inner = (slice(6, -6), slice(6, -6))
    before = np.abs(pixels[..., 0].astype(float) - ideal)[inner]
    after = np.abs(got - ideal)[inner]
    assert after.sum() < 0.62 * before.sum()
    assert after.max() < before.max()
    far = np.abs(coverage - 0.5) == 0.5
    changed = got != pixels[..., 0]
    assert changed[~far].mean() > 0.5
    assert abs(got.mean() - ideal.mean()) < 1.0


def test_fxaa_calms_a_lone_pixel(device: Device) -> None:
    pixels = np.full((17, 17, 4), 255, np.uint8)
    pixels[..., :3] = 20
    pixels[8, 8, :3] = 240
    got = smoothed(device, pixels)
    assert got[8, 8, 0] < 200
