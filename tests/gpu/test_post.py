"""Tone mapping and FXAA on pictures with known answers. PP-10"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8, RGBA16F, Format
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, TextureHandle
from elemental.passes.post.fxaa import fxaa
from elemental.passes.post.tonemap import tonemap
from gpu.rig import IDENTITY, read

Array = npt.NDArray[Any]
Filter = Callable[[Graph, Block, AnyTexture], TextureHandle]


def view_block(width: int, height: int, exposure: float = 1.0) -> Block:
    matrices = ("clip_from_world", "world_from_clip", "view_from_world", "world_from_view")
    return pack(
        layouts().block("View"),
        **dict.fromkeys(matrices, IDENTITY),
        viewport_px=(width, height, 1 / width, 1 / height),
        eye_ws=(0, 0, 0),
        exposure=exposure,
        near=0.1,
        far=10.0,
        time_s=0.0,
        frame=0,
    )


def run(
    device: Device, apply: Filter, pixels: Array, format: Format, exposure: float = 1.0
) -> Array:
    """(H, W, 4) result of one filter; rows stay in their order."""
    height, width = pixels.shape[:2]
    source = device.texture("source", (width, height), format, data=pixels.astype(format.dtype))
    g = device.begin_frame()
    result = read(g, apply(g, view_block(width, height, exposure), source))[::-1].copy()
    source.release()
    return result


def filmic_codes(x: Array) -> Array:
    y = np.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0, 1)
    return (
        np.where(y <= 0.0031308, 12.92 * y, 1.055 * np.maximum(y, 1e-9) ** (1 / 2.4) - 0.055) * 255
    )


def test_the_picture_is_the_curve_within_its_dither(device: Device) -> None:
    levels = np.concatenate([[0.0], np.exp2(np.linspace(-10, 6, 127))]).astype(np.float16)
    pixels = np.ones((32, 128, 4), np.float16)
    pixels[..., :3] = levels[None, :, None]
    got = run(device, tonemap, pixels, RGBA16F, exposure=0.5)[..., :3].astype(float)
    want = filmic_codes(levels.astype(float) * 0.5)
    assert np.abs(got - want[None, :, None]).max() < 1.6
    means = got.mean(axis=(0, 2))
    np.testing.assert_allclose(means[5:-5], want[5:-5], atol=0.35)
    assert np.all(np.diff(means) > -0.35)


def test_a_gradient_does_not_band(device: Device) -> None:
    """Over a ramp of two codes, column means follow the ramp instead of its two steps."""
    ramp = np.linspace(0.1800, 0.1835, 256)
    pixels = np.ones((64, 256, 4), np.float32)
    pixels[..., :3] = ramp[None, :, None]
    got = run(device, tonemap, pixels, RGBA16F)[..., 0].astype(float)
    means = got.mean(axis=0).reshape(16, 16).mean(axis=1)
    want = filmic_codes(ramp.astype(np.float16).astype(float)).reshape(16, 16).mean(axis=1)
    assert np.ptp(want) > 1.0
    np.testing.assert_allclose(means, want, atol=0.12)


def test_fxaa_leaves_flat_and_soft_areas_bit_identical(device: Device) -> None:
    rng = np.random.default_rng(4)
    flat = np.full((48, 64, 4), 255, np.uint8)
    flat[..., :3] = rng.integers(118, 122, (48, 64, 3))
    np.testing.assert_array_equal(run(device, fxaa, flat, RGBA8), flat)


def test_fxaa_leaves_straight_edges_sharp(device: Device) -> None:
    """A long edge along the pixels has nothing to smooth but its own end."""
    pixels = np.full((40, 64, 4), 255, np.uint8)
    pixels[:20, :, :3] = 30
    got = run(device, fxaa, pixels, RGBA8)
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
    got = run(device, fxaa, pixels, RGBA8)[..., 0].astype(float)
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
    got = run(device, fxaa, pixels, RGBA8)
    assert got[8, 8, 0] < 200
