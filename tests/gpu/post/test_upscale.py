"""Screen percentage: a picture drawn smaller and enlarged. PP-10"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.passes.post.fxaa import fxaa
from elemental.passes.post.scale import drawn_size, upscale
from elemental.settings import Settings
from gpu.moving import EYE, stage
from gpu.post.darkroom import PLAIN, Array
from gpu.rig import read

Filter = Callable[[Graph, TextureHandle], TextureHandle]


def filtered(device: Device, pixels: Array, apply: Filter) -> Array:
    """(H, W, 4) uint8 that a filter makes of display codes; rows stay in their order."""
    height, width = pixels.shape[:2]
    source = device.texture("source", (width, height), RGBA8, data=np.ascontiguousarray(pixels))
    g = device.begin_frame()
    copy = g.texture("copy", like=source)
    g.copy_texture(source, copy)
    result = read(g, apply(g, copy))[::-1].copy()
    source.release()
    return result


def enlarged(device: Device, pixels: Array, size: tuple[int, int]) -> Array:
    return filtered(device, pixels, lambda g, image: upscale(g, image, size))


def smooth_picture(width: int, height: int) -> Array:
    """(H, W) 0..255: waves sampled at the pixels' centres, the same whatever the size."""
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    waves = np.sin(110 * x + 30 * y) + np.sin(90 * y - 40 * x) + np.sin(120 * x * y)
    return np.asarray(127.5 + 40 * waves)


def bilinear(pixels: Array, width: int, height: int) -> Array:
    y = np.clip((np.arange(height) + 0.5) / height * len(pixels) - 0.5, 0, len(pixels) - 1)
    x = np.clip((np.arange(width) + 0.5) / width * pixels.shape[1] - 0.5, 0, pixels.shape[1] - 1)
    rows = np.array([np.interp(y, np.arange(len(pixels)), column) for column in pixels.T]).T
    return np.array([np.interp(x, np.arange(pixels.shape[1]), row) for row in rows])


def grey(levels: Array) -> Array:
    codes = np.full((*levels.shape, 4), 255, np.uint8)
    codes[..., :3] = np.round(levels)[..., None]
    return codes


@pytest.mark.parametrize("percentage", [50.0, 75.0, 90.0])
def test_it_errs_less_than_a_linear_filter(device: Device, percentage: float) -> None:
    size = (200, 150)
    small = np.round(smooth_picture(*drawn_size(size, percentage)))
    want = smooth_picture(*size)
    got = enlarged(device, grey(small), size)[..., 0].astype(float)
    inner = (slice(4, -4), slice(4, -4))
    error = np.sqrt(((got - want)[inner] ** 2).mean())
    linear = np.sqrt(((bilinear(small, *size) - want)[inner] ** 2).mean())
    assert error < 0.6 * linear


def test_it_does_not_ring(device: Device) -> None:
    rng = np.random.default_rng(3)
    levels = rng.choice([20.0, 230.0], (30, 40))
    got = enlarged(device, grey(levels), (64, 48))[..., 0]
    assert (got.min(), got.max()) == (20, 230)
    flat = np.full((30, 40), 77.0)
    np.testing.assert_array_equal(enlarged(device, grey(flat), (53, 41))[..., :3], 77)


def test_a_picture_of_its_own_size_is_left_alone(device: Device) -> None:
    rng = np.random.default_rng(3)
    codes = grey(rng.uniform(0, 255, (20, 30)))
    np.testing.assert_array_equal(enlarged(device, codes, (30, 20)), codes)
    device.finish()
    assert "post/upscale" not in [timing.name for timing in device.timings]


def test_edges_are_smoothed_before_they_are_enlarged(device: Device) -> None:
    """The other way round FXAA meets blurred edges, and finds fewer of them."""
    size, (width, height) = (160, 120), drawn_size((160, 120), 90.0)

    def coverage(width: int, height: int, samples: int) -> Array:
        place = (np.arange(width * samples) + 0.5) / (width * samples)
        x, y = np.meshgrid(place, (np.arange(height * samples) + 0.5) / (height * samples))
        inside = (y > 0.4 + 0.17 * x) ^ (x > 0.55 + 0.09 * y)
        return np.asarray(inside.reshape(height, samples, width, samples).mean(axis=(1, 3)))

    small = grey(25 + 205 * coverage(width, height, 1))
    want = 25 + 205 * coverage(*size, 16)
    errors = [
        np.abs(filtered(device, small, order)[..., 0] - want).mean()
        for order in (
            lambda g, image: upscale(g, fxaa(g, image), size),
            lambda g, image: fxaa(g, upscale(g, image, size)),
            lambda g, image: upscale(g, image, size),
        )
    ]
    assert errors[0] < errors[1] < errors[2]


def test_the_frame_has_its_size_and_fewer_pixels(device: Device) -> None:
    pictures = []
    for percentage in (100.0, 90.0, 25.0):
        settings = Settings({**PLAIN, "gi.enabled": False, "screen.percentage": percentage})
        renderer = Renderer(device, stage(), settings, (64, 48))
        pictures.append(renderer.read(renderer.render(EYE, 0.0, 0)).astype(int))
        views = renderer.read(renderer.render(EYE, 0.0, 0, "normal"))
        assert views.shape[:2] == (48, 64)
        renderer.release()
    full, near, coarse = (picture[..., :3] for picture in pictures)
    assert full.shape == near.shape == coarse.shape
    assert np.abs(full - near).mean() < np.abs(full - coarse).mean() < 20


def test_no_percentage_makes_a_picture_vanish() -> None:
    assert drawn_size((1, 3), 25.0) == (1, 1)
    assert drawn_size((1920, 1080), 90.0) == (1728, 972)
    assert drawn_size((321, 181), 100.0) == (321, 181)
