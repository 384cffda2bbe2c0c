"""The film curve and the vignette. PP-09, PP-12"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from elemental.core.layout import Block
from elemental.gpu.device import Device
from elemental.passes.post.film import film_block
from elemental.settings import Settings
from glsl.harness import run_glsl

Array = npt.NDArray[Any]
RADIANCE = np.concatenate([[0.0], np.exp2(np.linspace(-14, 12, 2000))])
TABLE = (0.88, 0.55, 0.26, 0.0, 0.04)


def film(**given: float) -> Block:
    names = {key.replace("__", "."): value for key, value in given.items()}
    return film_block(Settings(names), (), 0)


def curve(device: Device, x: Array, *values: float) -> Array:
    keys = ("film__slope", "film__toe", "film__shoulder", "film__black_clip", "film__white_clip")
    block = film(**dict(zip(keys, values, strict=True)))
    body = "film_curve(vec3(x)).r"
    return run_glsl(device, ["lib/film.glsl"], body, {"x": x}, params={"Film": block})


def model(x: Array, slope: float, toe: float, shoulder: float, black: float, white: float) -> Array:
    """A line through grey with a tanh that leaves it below 1 - toe, one above the shoulder."""
    decades = np.log10(np.maximum(x, 1e-10))
    low_end, high_end = 1 - toe + black, 1 + white - shoulder
    into = 0.18 - (1 - toe)
    into = low_end * np.arctanh(into / low_end) if into < 0 else into
    toe_start = np.log10(0.18) - into / slope
    line = 1 - toe + slope * (decades - toe_start)
    below, above = np.minimum(line - (1 - toe), 0), np.maximum(line - shoulder, 0)
    bent = line - below + low_end * np.tanh(below / low_end)
    bent += high_end * np.tanh(above / high_end) - above
    return np.asarray(np.clip(bent, 0, 1))


@pytest.mark.parametrize(
    "values", [TABLE, (1.2, 0.9, 0.9, 0.0, 0.0), (0.5, 0.2, 0.1, 0.1, 0.2), (0.88, 0.3, 0.7, 0, 0)]
)
def test_the_curve_is_the_models(device: Device, values: tuple[float, ...]) -> None:
    got = curve(device, RADIANCE, *values)
    np.testing.assert_allclose(got, model(RADIANCE, *values), atol=2e-5)


def test_the_tables_curve_rises_from_black_to_white_through_grey(device: Device) -> None:
    y = curve(device, RADIANCE, *TABLE)
    assert y[0] == 0.0
    assert np.all(np.diff(y) >= -1e-6)
    assert y[-1] > 0.995
    assert curve(device, np.array([0.18]), *TABLE)[0] == pytest.approx(0.18, abs=1e-4)


unit = st.floats(0, 1)


@settings(max_examples=25, deadline=None)
@given(st.floats(0.1, 2), unit, unit, unit, unit)
def test_no_setting_makes_the_curve_fall(
    slope: float, toe: float, shoulder: float, black: float, white: float
) -> None:
    y = model(RADIANCE, slope, min(toe, 0.99), min(shoulder, 0.99), black, white)
    assert np.all(np.diff(y) >= -1e-9)


def test_the_vignette_is_the_cosines_fourth_power(device: Device) -> None:
    angles = np.linspace(0, 1, 50)
    block = film(vignette__intensity=0.7)
    body = "vignette(vec2(0.6, 0.8) * r)"
    got = run_glsl(device, ["lib/film.glsl"], body, {"r": angles}, params={"Film": block})
    np.testing.assert_allclose(got, np.cos(np.arctan(0.7 * angles)) ** 4, rtol=1e-5)
