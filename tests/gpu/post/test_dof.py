"""Depth of field: the size of a blurred point, what stays sharp, what covers what. PP-12"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, TextureHandle
from elemental.passes.post.dof import depth_of_field
from gpu.post.conftest import MakeDarkroom
from gpu.post.darkroom import Array, Darkroom, flat

NEAR, FAR = 0.1, 100.0
FOCUS: dict[str, Any] = {
    "dof__enabled": True,
    "dof__focal_distance": 1000.0,
    "dof__near_transition": 400.0,
    "dof__far_transition": 1000.0,
    "dof__max_bokeh_size": 20.0,
    "dof__f_stop": 2.0,
}
"""Sharp at 10 m; from 6 m and nearer, and from 20 m on, circles of a tenth of the width."""


def depth_at(metres: float | Array) -> Array:
    """Of the depth buffer, 0..1."""
    return np.asarray(FAR * (1 - NEAR / np.asarray(metres)) / (FAR - NEAR))


def blurred(room: Darkroom, pixels: Array, depth: Array) -> Array:
    """(H, W, 3) float64 radiance."""

    def passes(g: Graph, picture: AnyTexture, behind: AnyTexture) -> TextureHandle:
        view = room.view(picture.size)
        result = depth_of_field(g, view, picture, behind, room.settings)  # type: ignore[arg-type]
        assert result is not picture
        return result

    return room.run(passes, pixels, depth)[..., :3].astype(np.float64)


def lamp() -> Array:
    pixels = flat(128, 200, 0.0)
    pixels[63:65, 99:101, :3] = 1000.0
    return pixels


@pytest.mark.parametrize(("metres", "diameter_px"), [(20.0, 20.0), (60.0, 20.0), (15.0, 10.0)])
def test_a_point_behind_the_focus_is_a_disc_of_its_circle(
    darkroom: MakeDarkroom, metres: float, diameter_px: float
) -> None:
    got = blurred(darkroom(**FOCUS), lamp(), np.full((128, 200), depth_at(metres)))[..., 0]
    assert got.sum() == pytest.approx(4000.0, rel=0.05)
    y, x = np.mgrid[0:128, 0:200]
    distance2 = (y - 63.5) ** 2 + (x - 99.5) ** 2
    # A uniform disc of radius r has a mean squared distance of r^2 / 2.
    radius = np.sqrt(2 * (got * distance2).sum() / got.sum())
    assert 2 * radius == pytest.approx(diameter_px + 1.0, rel=0.12)  # texels are two pixels wide
    assert got[distance2 > (0.5 * diameter_px + 5) ** 2].max() == 0.0


def test_a_point_before_the_focus_is_one_too(darkroom: MakeDarkroom) -> None:
    got = blurred(darkroom(**FOCUS), lamp(), np.full((128, 200), depth_at(4.0)))[..., 0]
    assert got.sum() == pytest.approx(4000.0, rel=0.1)
    assert (got > 1.0).sum() == pytest.approx(np.pi * 10**2, rel=0.35)


def test_what_is_in_focus_keeps_its_bits(darkroom: MakeDarkroom) -> None:
    rng = np.random.default_rng(1)
    pixels = rng.uniform(0, 4, (64, 96, 4)).astype(np.float16)
    got = blurred(darkroom(**FOCUS), pixels, np.full((64, 96), depth_at(10.0)))
    np.testing.assert_array_equal(got, pixels[..., :3].astype(np.float64))


def test_flat_areas_keep_their_radiance(darkroom: MakeDarkroom) -> None:
    depth = depth_at(np.linspace(3.0, 60.0, 96)[None, :].repeat(64, axis=0))
    got = blurred(darkroom(**FOCUS), flat(64, 96, 2.0), depth)
    np.testing.assert_allclose(got, 2.0, rtol=0.01)


def test_a_sharp_edge_before_a_blurred_wall_stays(darkroom: MakeDarkroom) -> None:
    """Light of the sharp half does not get into the blurred one, nor the other way round."""
    pixels, depth = flat(64, 96, 0.1), np.full((64, 96), depth_at(40.0))
    pixels[:, :48, :3] = 5.0
    depth[:, :48] = depth_at(10.0)
    got = blurred(darkroom(**FOCUS), pixels, depth)[..., 0]
    np.testing.assert_allclose(got[:, :48], 5.0, rtol=1e-3)
    assert got[:, 50:].max() < 0.4


def test_what_is_near_spreads_over_what_is_sharp(darkroom: MakeDarkroom) -> None:
    pixels, depth = flat(64, 200, 0.0), np.full((64, 200), depth_at(10.0))
    pixels[:, :100, :3] = 1.0
    depth[:, :100] = depth_at(3.0)
    got = blurred(darkroom(**FOCUS), pixels, depth)[32, :, 0]
    assert got[100] == pytest.approx(0.5, abs=0.15)  # half of a circle at the edge
    assert got[105] > 0.05
    assert got[114] == 0.0
    assert got[84] == pytest.approx(1.0, abs=0.06)
    assert np.all(np.diff(got[84:114]) < 0.02)


def test_what_is_near_is_not_in_the_blur_behind_it(darkroom: MakeDarkroom) -> None:
    pixels, depth = flat(64, 200, 0.0), np.full((64, 200), depth_at(60.0))
    pixels[:, :100, :3] = 1.0
    depth[:, :100] = depth_at(3.0)
    got = blurred(darkroom(**FOCUS), pixels, depth)[32, :, 0]
    assert got[100] == pytest.approx(0.5, abs=0.15)
    assert got[104] < 0.35


def test_the_f_stop_divides(darkroom: MakeDarkroom) -> None:
    depth = np.full((128, 200), depth_at(60.0))
    areas = []
    for stop in (2.0, 4.0):
        room = darkroom(**FOCUS)
        room.set(dof__f_stop=stop)
        areas.append((blurred(room, lamp(), depth)[..., 0] > 0.5).sum())
    assert areas[0] / areas[1] == pytest.approx(4.0, rel=0.45)


def test_it_is_off_by_default_and_where_nothing_would_blur(darkroom: MakeDarkroom) -> None:
    room = darkroom()
    room.develop(flat(8, 8, 1.0))
    assert room.passes() == ["post/tonemap"]
    room.set(dof__enabled=True, dof__max_bokeh_size=0.0)
    room.develop(flat(8, 8, 1.0))
    assert room.passes() == ["post/tonemap"]
