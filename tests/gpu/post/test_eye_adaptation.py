"""Eye adaptation: what is averaged, how it is followed, where it is read. PP-08"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from elemental.core.paths import glsl_root
from gpu.post.conftest import MakeDarkroom
from gpu.post.darkroom import Array, flat, hdr
from gpu.post.test_histogram import ADAPTS

WIDE: dict[str, Any] = {
    "eye_adaptation__min_brightness": 0.001,
    "eye_adaptation__max_brightness": 10.0,
}

WHOLE: dict[str, Any] = {
    "eye_adaptation__low_percent": 0.0,
    "eye_adaptation__high_percent": 100.0,
}


def average(histogram: Array, low: float, high: float) -> float:
    """Of 64 buckets from -8 to 4 EV: mean brightness of the shares between low and high."""
    ends = np.cumsum(histogram.astype(np.float64))
    used = np.clip(ends, low, high) - np.clip(ends - histogram, low, high)
    return float(used @ np.exp2(np.linspace(-8, 4, 64)) / used.sum())


@pytest.mark.parametrize(("low", "high"), [(80.0, 98.3), (0.0, 100.0), (50.0, 50.0), (99.9, 20.0)])
def test_it_averages_between_the_percentiles(
    darkroom: MakeDarkroom, low: float, high: float
) -> None:
    room = darkroom(**WIDE, eye_adaptation__low_percent=low, eye_adaptation__high_percent=high)
    room.develop(hdr(64, 96))
    eye = room.eye()
    first = min(low / 100, 0.999)
    want = average(eye["histogram"].reshape(64), first, max(high / 100, first + 0.001))
    assert eye["measured"] == pytest.approx(want, rel=2e-3)
    assert eye["brightness"] == pytest.approx(np.clip(want, 0.001, 10), rel=2e-3)


@pytest.mark.parametrize("radiance", [0.02, 0.3, 0.77, 3.0])
def test_a_flat_picture_is_what_it_is(darkroom: MakeDarkroom, radiance: float) -> None:
    """To a bucket's width between two percentiles, and much closer over all of it."""
    room = darkroom(**WIDE)
    room.develop(flat(40, 60, radiance))
    assert abs(np.log2(room.eye()["measured"] / radiance)) < 12 / 63
    room.set(**WHOLE)
    room.develop(flat(40, 60, radiance))
    assert room.eye()["measured"] == pytest.approx(radiance, rel=3e-3)


def test_it_follows_the_formula_over_time(darkroom: MakeDarkroom) -> None:
    """new = target + (old - target) exp2(-dt speed), faster towards the bright."""
    room = darkroom(**WIDE, eye_adaptation__speed_up=3.0, eye_adaptation__speed_down=1.0)
    dark, bright = flat(32, 32, 0.05), flat(32, 32, 1.6)
    room.develop(dark, 0.0)
    old, low = room.eye()["brightness"], room.eye()["measured"]
    assert old == low  # the first frame is adapted
    time = 0.0
    for step, picture in [(0.1, bright), (0.25, bright), (0.0, bright), (0.1, dark), (0.4, dark)]:
        time += step
        room.develop(picture, time)
        eye = room.eye()
        speed = 3.0 if picture is bright else 1.0
        want = eye["measured"] + (old - eye["measured"]) * 2.0 ** (-step * speed)
        assert eye["brightness"] == pytest.approx(want, rel=1e-4)
        old = eye["brightness"]
    assert low < old < 1.6


def test_half_the_way_up_takes_a_third_of_a_second(darkroom: MakeDarkroom) -> None:
    room = darkroom(**WIDE, **WHOLE)
    room.develop(flat(8, 8, 0.1), 0.0)
    for k in range(1, 11):
        room.develop(flat(8, 8, 1.1), k / 30)
    assert room.eye()["brightness"] == pytest.approx(0.6, rel=5e-3)


def test_after_a_cut_it_is_adapted_at_once(darkroom: MakeDarkroom) -> None:
    room = darkroom(**WIDE, **WHOLE)
    room.develop(flat(8, 8, 0.1), 5.0)
    room.develop(flat(8, 8, 1.0), 4.0)
    assert room.eye()["brightness"] == pytest.approx(1.0, rel=5e-3)
    room.develop(flat(8, 8, 0.1), 9.0)
    assert room.eye()["brightness"] == pytest.approx(0.1, rel=5e-3)


def test_it_stays_in_its_bounds(darkroom: MakeDarkroom) -> None:
    room = darkroom(**ADAPTS)
    room.develop(flat(8, 8, 14.0))
    assert room.eye()["brightness"] == 2.0
    room.set(eye_adaptation__max_brightness=0.5)
    room.develop(flat(8, 8, 14.0))
    assert room.eye()["brightness"] == 0.5


def test_pictures_of_any_brightness_look_alike(darkroom: MakeDarkroom) -> None:
    room = darkroom(**WIDE, eye_adaptation__log_max=4.6)  # two stops are ten buckets
    pixels = hdr(48, 64)
    pixels[..., :3] = np.clip(pixels[..., :3], 0.02, 8)
    one = room.develop(pixels, 0.0).astype(int)
    other = room.develop(pixels / 4, 10.0).astype(int)
    assert np.abs(one - other).max() <= 2
    assert one[..., 1].std() > 20


def test_equal_bounds_switch_it_off(darkroom: MakeDarkroom) -> None:
    """Nothing is measured; the bound is what is shown as 1."""
    room = darkroom()
    codes = room.develop(flat(8, 8, 0.4))
    assert room.passes() == ["post/tonemap"]
    room.set(eye_adaptation__min_brightness=0.5, eye_adaptation__max_brightness=0.5)
    np.testing.assert_array_equal(room.develop(flat(8, 8, 0.2)), codes)
    assert room.passes() == ["post/tonemap"]


def test_the_bias_comes_after_it(darkroom: MakeDarkroom) -> None:
    room = darkroom(**WIDE, **WHOLE)
    room.develop(flat(8, 8, 0.2))
    room.set(exposure=1.0)
    biased = room.develop(flat(8, 8, 0.2), 0.1)
    room.set(exposure=0.0)
    assert biased.mean() > room.develop(flat(8, 8, 0.2), 0.2).mean() + 3
    assert room.eye()["brightness"] == pytest.approx(0.2, rel=5e-3)


def test_it_is_read_in_the_vertex_shader_alone() -> None:
    """[Mittring12]: "Read result in tone mapping VS, pass to PS as interpolator"."""
    vertex = (glsl_root() / "post/screen.vert.glsl").read_text()
    fragment = (glsl_root() / "post/tonemap.frag.glsl").read_text()
    assert re.search(r"v_exposure = .*eye\.brightness", vertex)
    assert "EyeState" not in fragment
    assert "flat in float v_exposure" in fragment
