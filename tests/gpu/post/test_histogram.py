"""The histogram of a picture against numpy's. PP-07"""

from __future__ import annotations

import re

import numpy as np
import pytest

from elemental.core.paths import glsl_root
from elemental.passes.post.exposure import exposure_block, histogram_lines
from gpu.post.conftest import MakeDarkroom
from gpu.post.darkroom import Array, flat, hdr, luminance

ADAPTS = {"eye_adaptation__min_brightness": 0.03, "eye_adaptation__max_brightness": 2.0}


def halved(pixels: Array) -> Array:
    """Means of 2x2 texels; an odd row (the bottom is row 0 on the GPU) or column is repeated."""
    height, width = pixels.shape[:2]
    odd = ((height % 2, 0), (0, width % 2), (0, 0))
    padded = np.pad(pixels.astype(np.float64), odd, mode="edge")
    return (padded[::2, ::2] + padded[1::2, ::2] + padded[::2, 1::2] + padded[1::2, 1::2]) / 4


def numpy_histogram(brightness: Array, log_min: float = -8, log_max: float = 4) -> Array:
    """(64,) shares: each value split between the two nearest of 64 buckets."""
    place = (np.log2(np.maximum(brightness, 1e-20)) - log_min) / (log_max - log_min)
    place = np.clip(place, 0, 1) * 63
    lower = np.minimum(np.floor(place), 62)
    edges = np.arange(65) - 0.5
    below = np.histogram(lower, edges, weights=1 - (place - lower))[0]
    above = np.histogram(lower + 1, edges, weights=place - lower)[0]
    return np.asarray((below + above) / brightness.size)


SIZES = [(64, 64), (75, 131), (3, 2), (1, 1), (90, 260)]


@pytest.mark.parametrize("size", SIZES)
def test_the_lines_add_up_to_numpys(darkroom: MakeDarkroom, size: tuple[int, int]) -> None:
    """A line of 16 texels for each tile, and together numpy's histogram to rounding."""
    pixels = hdr(*size, seed=size[0])
    room = darkroom(**ADAPTS)
    block = exposure_block(room.settings, 0.0, starts=True)
    lines = room.run(lambda g, picture, _: histogram_lines(g, picture, block), pixels)
    assert lines.shape == (-(-size[0] // 32) * -(-size[1] // 32), 16, 4)
    want = numpy_histogram(luminance(pixels)) * size[0] * size[1]
    np.testing.assert_allclose(lines.sum(axis=0).reshape(64), want, rtol=1e-4, atol=2e-3)


@pytest.mark.parametrize("size", SIZES)
def test_the_frames_is_that_of_half_the_size(darkroom: MakeDarkroom, size: tuple[int, int]) -> None:
    pixels = hdr(*size, seed=size[0])
    room = darkroom(**ADAPTS)
    room.develop(pixels)
    got = room.eye()["histogram"].reshape(64)
    np.testing.assert_allclose(got, numpy_histogram(luminance(halved(pixels))), atol=4e-3)
    assert got.sum() == pytest.approx(1.0, abs=1e-5)


def test_its_range_is_set(darkroom: MakeDarkroom) -> None:
    pixels = hdr(40, 56)
    room = darkroom(**ADAPTS, eye_adaptation__log_min=-2.0, eye_adaptation__log_max=1.0)
    room.develop(pixels)
    want = numpy_histogram(luminance(halved(pixels)), -2, 1)
    np.testing.assert_allclose(room.eye()["histogram"].reshape(64), want, atol=2e-3)
    assert want[0] > 0.1
    assert want[63] > 0.1


def test_black_falls_into_the_first_bucket(darkroom: MakeDarkroom) -> None:
    room = darkroom(**ADAPTS)
    room.develop(flat(16, 16, 0.0))
    np.testing.assert_array_equal(room.eye()["histogram"].reshape(64), np.eye(64)[0])


def test_it_counts_as_on_the_slide() -> None:
    """64 buckets in 16 columns of group-shared floats, and not an atomic in sight."""
    text = (glsl_root() / "post/histogram.comp.glsl").read_text()
    assert "shared float histograms[HISTOGRAM_BUCKETS][COLUMNS]" in text
    assert "COLUMNS = 16u" in text
    code = re.sub(r"//[^\n]*", "", text)
    assert "atomic" not in code
    assert code.count("barrier()") == 2
