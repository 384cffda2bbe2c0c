"""The pass from radiance to display codes: curve, dither, grading, grain, vignette, fringe."""

# PP-09, PP-12

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from elemental.core.errors import InputError
from elemental.scene.volumes import Volume, blend
from glsl.test_film import TABLE, model
from gpu.post.conftest import MakeDarkroom
from gpu.post.darkroom import Array, flat, hdr

LUT = "color_grading.lut"


def codes(radiance: Array) -> Array:
    """Display codes, not rounded, of the table's film curve."""
    y = model(radiance, *TABLE)
    low, high = 12.92 * y, 1.055 * np.maximum(y, 1e-9) ** (1 / 2.4) - 0.055
    return np.asarray(255 * np.where(y <= 0.0031308, low, high))


def test_the_picture_is_the_curve_within_its_dither(darkroom: MakeDarkroom) -> None:
    levels = np.concatenate([[0.0], np.exp2(np.linspace(-10, 6, 127))]).astype(np.float16)
    pixels = np.ones((32, 128, 4), np.float16)
    pixels[..., :3] = levels[None, :, None]
    got = darkroom(exposure=-1.0).develop(pixels)[..., :3].astype(float)
    want = codes(levels.astype(float) * 0.5)
    assert np.abs(got - want[None, :, None]).max() < 1.6
    means = got.mean(axis=(0, 2))
    np.testing.assert_allclose(means[5:-5], want[5:-5], atol=0.35)


def test_a_gradient_does_not_band(darkroom: MakeDarkroom) -> None:
    """Over a ramp of a few codes, column means follow the ramp instead of its steps."""
    ramp = np.linspace(0.1800, 0.1835, 256)
    pixels = np.ones((64, 256, 4), np.float16)
    pixels[..., :3] = ramp[None, :, None]
    got = darkroom().develop(pixels)[..., 0].astype(float)
    means = got.mean(axis=0).reshape(16, 16).mean(axis=1)
    want = codes(ramp.astype(np.float16).astype(float)).reshape(16, 16).mean(axis=1)
    assert np.ptp(want) > 1.0
    np.testing.assert_allclose(means, want, atol=0.12)


def cube_file(path: Path, size: int, axes: int, of: str = "identity") -> str:
    """A look-up table that keeps colours, or swaps red and blue or inverts channels."""
    steps = np.linspace(0, 1, size)
    if axes == 3:
        blue, green, red = np.meshgrid(steps, steps, steps, indexing="ij")
        rows = np.stack([red, green, blue], axis=-1).reshape(-1, 3)
    else:
        rows = np.repeat(steps[:, None], 3, axis=1)
    rows = {"identity": rows, "swapped": rows[:, ::-1], "inverted": 1 - rows}[of]
    lines = [f"LUT_{axes}D_SIZE {size}", *(f"{r:.6f} {g:.6f} {b:.6f}" for r, g, b in rows)]
    path.write_text("\n".join(lines))
    return str(path)


@pytest.mark.parametrize(("size", "axes"), [(2, 3), (17, 3), (33, 3), (2, 1), (1024, 1), (9000, 1)])
def test_a_neutral_table_changes_nothing(
    darkroom: MakeDarkroom, tmp_path: Path, size: int, axes: int
) -> None:
    pixels = hdr(64, 64)
    name = cube_file(tmp_path / "neutral.cube", size, axes)
    plain = darkroom().develop(pixels).astype(int)
    graded = darkroom(color_grading__lut=name).develop(pixels).astype(int)
    difference = np.abs(graded - plain)
    assert difference.max() <= 1
    assert (difference > 0).mean() < 0.12  # half floats move a value by an eighth of a code


def test_a_table_replaces_colours_by_its_share(darkroom: MakeDarkroom, tmp_path: Path) -> None:
    pixels = hdr(32, 32)
    name = cube_file(tmp_path / "swapped.cube", 5, 3, "swapped")
    plain = darkroom().develop(pixels).astype(int)
    swapped = darkroom(color_grading__lut=name).develop(pixels).astype(int)
    assert np.abs(swapped[..., [2, 1, 0]] - plain[..., :3]).max() <= 2  # the dither is not swapped
    half = darkroom(color_grading__lut=name, color_grading__intensity=0.5).develop(pixels)
    assert np.abs(half[..., 0].astype(int) - half[..., 2]).max() <= 3
    none = darkroom(color_grading__lut=name, color_grading__intensity=0.0).develop(pixels)
    np.testing.assert_array_equal(none, plain)


def test_curves_and_domains_are_honoured(darkroom: MakeDarkroom, tmp_path: Path) -> None:
    pixels = hdr(32, 32)
    plain = darkroom().develop(pixels).astype(float)
    name = cube_file(tmp_path / "inverted.cube", 16, 1, "inverted")
    inverted = darkroom(color_grading__lut=name).develop(pixels).astype(float)
    np.testing.assert_allclose((inverted + plain)[..., :3], 255, atol=2.5)
    text = "DOMAIN_MAX 0.5 0.5 0.5\n" + Path(name).read_text()
    Path(name).write_text(text)
    steep = darkroom(color_grading__lut=name).develop(pixels).astype(float)
    np.testing.assert_allclose(steep[..., :3], np.maximum(255 - 2 * plain[..., :3], 0), atol=4.5)


@pytest.mark.parametrize("weight", [0.0, 0.25, 0.75, 1.0])
def test_volumes_blend_two_tables_by_their_weights(
    darkroom: MakeDarkroom, tmp_path: Path, weight: float
) -> None:  # PP-11
    pixels = hdr(32, 32)
    swapped = cube_file(tmp_path / "swapped.cube", 5, 3, "swapped")
    inverted = cube_file(tmp_path / "inverted.cube", 16, 1, "inverted")
    room = darkroom()
    pictures = {}
    for name in ("", swapped, inverted):
        room.set(color_grading__lut=name)
        pictures[name] = room.develop(pixels).astype(float)
    base = room.settings
    for below, above in (("", swapped), (swapped, inverted), (inverted, "")):
        volume = Volume("v", unbound=True, blend_weight=weight, overrides={LUT: above})
        room.settings = blend(base.replace({LUT: below}), [volume], (0, 0, 0))
        got = room.develop(pixels)[..., :3].astype(float)
        want = (1 - weight) * pictures[below] + weight * pictures[above]
        assert np.abs(got - want[..., :3]).max() <= 2  # codes: each side is rounded and dithered


def test_a_bad_table_is_refused_before_the_first_frame(
    darkroom: MakeDarkroom, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"none\.cube"):
        darkroom(color_grading__lut=str(tmp_path / "none.cube"))
    room = darkroom()
    room.set(color_grading__lut=str(tmp_path / "none.cube"))
    plain = room.develop(flat(4, 4, 0.5))  # in a running frame the effect goes without
    assert room.history.problems() == [f"{LUT}: {tmp_path / 'none.cube'}: does not exist"]
    np.testing.assert_array_equal(plain, darkroom().develop(flat(4, 4, 0.5)))


def test_a_bad_table_leaves_the_last_good_one(darkroom: MakeDarkroom, tmp_path: Path) -> None:
    (tmp_path / "inverted.cube").write_text("LUT_1D_SIZE 2\n1 1 1\n0 0 0\n")
    room = darkroom(color_grading__lut=str(tmp_path / "inverted.cube"))
    before = room.develop(flat(4, 4, 0.1))
    room.set(color_grading__lut=str(tmp_path / "none.cube"))
    np.testing.assert_array_equal(room.develop(flat(4, 4, 0.1)), before)
    room.set(color_grading__lut="")
    assert (room.develop(flat(4, 4, 0.1)) != before).any()


def test_grain_has_its_strength_and_no_mean(darkroom: MakeDarkroom) -> None:
    picture = flat(128, 128, 0.3)
    plain = darkroom().develop(picture).astype(float)
    room = darkroom(grain__intensity=0.2)
    first, second = (room.develop(picture).astype(float) for _ in range(2))
    grain = (first - plain)[..., :3]
    assert abs(grain.mean()) < 0.7
    assert grain.std() == pytest.approx(0.2 * 0.5 * 255 / np.sqrt(6), rel=0.06)
    assert abs(np.corrcoef(first[..., 0].ravel(), second[..., 0].ravel())[0, 1]) < 0.05


def test_the_vignette_darkens_towards_the_corners(darkroom: MakeDarkroom) -> None:
    room = darkroom(vignette__intensity=0.8)
    got = room.develop(flat(90, 160, 0.5))[..., 0].astype(float)
    y, x = np.mgrid[0:90, 0:160]
    place = np.hypot(2 * (x + 0.5) - 160, 2 * (y + 0.5) - 90) / np.hypot(90, 160)
    want = codes(0.5 * np.cos(np.arctan(0.8 * place)) ** 4)
    np.testing.assert_allclose(got, want, atol=1.6)


def test_fringe_parts_red_and_blue_at_the_rim(darkroom: MakeDarkroom) -> None:
    pixels = flat(32, 201, 0.0)
    pixels[:, 170, :3] = 1.0
    pixels[:, 100, :3] = 1.0
    got = darkroom(scene_color__fringe=1.0).develop(pixels)[..., :3].astype(float).mean(axis=0)
    across = np.arange(201)
    centers = [(got[140:, k] @ across[140:]) / got[140:, k].sum() for k in range(3)]
    shift = 0.01 * (170 - 100)
    assert centers[1] == pytest.approx(170, abs=0.1)
    assert centers[0] - centers[1] == pytest.approx(shift, rel=0.5)
    assert centers[2] - centers[1] == pytest.approx(-shift, rel=0.5)
    assert np.ptp(got[100]) <= 2  # the middle stays white


def test_the_white_point_turns_its_daylight_white(darkroom: MakeDarkroom) -> None:
    picture = flat(16, 16, 0.4)
    neutral = darkroom().develop(picture)[..., :3].astype(float).mean(axis=(0, 1))
    warm = darkroom(film__white_point=9000.0).develop(picture)[..., :3].astype(float)
    cold = darkroom(film__white_point=4000.0).develop(picture)[..., :3].astype(float)
    assert np.ptp(neutral) < 0.5
    red, _, blue = warm.mean(axis=(0, 1)) - neutral
    assert red > 3 > -3 > blue
    red, _, blue = cold.mean(axis=(0, 1)) - neutral
    assert blue > 3 > -3 > red


def test_the_tint_multiplies(darkroom: MakeDarkroom) -> None:
    tinted = darkroom(scene_color__tint=(1.0, 0.5, 0.25)).develop(flat(16, 16, 0.8))
    want = codes(np.array([0.8, 0.4, 0.2]))
    np.testing.assert_allclose(tinted[..., :3].mean(axis=(0, 1)), want, atol=0.5)
