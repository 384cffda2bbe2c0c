"""Colour temperature, lumens and photometric files against closed forms and published values."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from elemental.core.errors import InputError
from elemental.scene.blackbody import LUMINANCE, blackbody_color, blackbody_xyz
from elemental.scene.ies import LightProfile, parse_ies, read_ies
from elemental.scene.lights import Light, checked
from elemental.scene.photometry import solid_angle

WHITE, DOWN = np.ones(3, np.float32), np.array([0.0, -1.0, 0.0], np.float32)
LAMP = Light("lamp", "point", WHITE, 1.0, np.zeros(3, np.float32), DOWN)


@pytest.mark.parametrize(
    ("kelvin", "x", "y"),
    [
        (2000.0, 0.5267, 0.4133),
        (2855.54, 0.4476, 0.4074),  # standard illuminant A
        (4000.0, 0.3805, 0.3768),
        (6500.0, 0.3135, 0.3237),
        (10000.0, 0.2807, 0.2884),
    ],
)
def test_black_bodies_lie_on_the_planckian_locus(kelvin: float, x: float, y: float) -> None:
    """Chromaticities as published [Wyszecki82, table 1(3.11)]."""
    xyz = blackbody_xyz(kelvin)
    got = xyz[:2] / xyz.sum()
    np.testing.assert_allclose(got, [x, y], atol=0.004)


def test_a_temperature_changes_the_colour_and_not_the_luminance() -> None:
    colors = np.array(
        [blackbody_color(kelvin) for kelvin in (1000, 1800, 3000, 6500, 12000, 40000)]
    )
    np.testing.assert_allclose(colors @ LUMINANCE, 1.0, rtol=1e-6)
    assert np.all(np.diff(colors[:, 0]) < 0.0)
    assert np.all(np.diff(colors[:, 2]) >= 0.0)
    np.testing.assert_allclose(colors[3], 1.0, atol=0.06)  # nearly the white of the monitor
    warm = replace(LAMP, temperature=3000.0, color=WHITE / 2, intensity=8.0)
    np.testing.assert_allclose(warm.strength, 4.0 * colors[2], rtol=1e-6)
    np.testing.assert_array_equal(LAMP.strength, WHITE)


def test_lumens_of_points_and_cones() -> None:
    """4 pi for a point; of a cone what a random choice of directions finds."""
    assert solid_angle(LAMP) == pytest.approx(4.0 * math.pi)
    cosine = np.random.default_rng(1).uniform(-1, 1, 1_000_000)
    for inner, outer in ((0.0, 0.5), (0.3, 0.5), (0.5, 0.5), (0.0, math.pi / 2)):
        spot = replace(LAMP, kind="spot", inner_angle=inner, outer_angle=outer)
        width = max(math.cos(inner) - math.cos(outer), 1e-6)
        through = np.clip((cosine - math.cos(outer)) / width, 0, 1) ** 2
        assert solid_angle(spot) == pytest.approx(4 * math.pi * through.mean(), rel=0.01)


def ies(
    vertical: Any, horizontal: Any, candela: Any, *, head: str = "IESNA:LM-63-2002\n",
    tilt: str = "NONE", factors: str = "1 1000 1", kind: int = 1, ballast: str = "1 1 50",
) -> str:  # fmt: skip
    """A photometric file."""
    numbers = [" ".join(f"{v:g}" for v in np.ravel(a)) for a in (vertical, horizontal, candela)]
    counts = f"{len(vertical)} {len(horizontal)} {kind} 2 0 0 0"
    return f"{head}[TEST] none\nTILT={tilt}\n{factors} {counts}\n{ballast}\n" + "\n".join(numbers)


HERE = Path("lamp.ies")
HALF = np.arange(0, 91, 5)


def test_a_cosine_luminaire_sends_pi_times_its_peak() -> None:
    profile = parse_ies(ies(HALF, [0], 500 * np.cos(np.radians(HALF))), HERE)
    assert profile.peak == pytest.approx(500.0)
    assert solid_angle(replace(LAMP, profile=profile)) == pytest.approx(math.pi, rel=2e-3)
    spot = replace(LAMP, kind="spot", profile=profile, inner_angle=0.6, outer_angle=0.6)
    # Inside a sharp cone of half angle a: pi sin^2 a.
    assert solid_angle(spot) == pytest.approx(math.pi * math.sin(0.6) ** 2, rel=6e-3)
    image = profile.image(8, 180)
    np.testing.assert_allclose(image[:, 3], image[:, 0])
    rows = np.radians(np.arange(180) + 0.5)
    np.testing.assert_allclose(image[:, 0], np.clip(np.cos(rows), 0, 1), atol=0.006)


def test_multiplier_and_ballast_scale_the_candela() -> None:
    text = ies([0, 90], [0], [100, 50], factors="2 1000 3", ballast="0.5 0.9 50")
    np.testing.assert_allclose(parse_ies(text, HERE).candela, [[135.0, 67.5]])


@pytest.mark.parametrize("planes", [[0, 90], [0, 90, 180], [0, 90, 180, 270, 360], [90, 180, 270]])
def test_symmetric_planes_are_completed(planes: list[int]) -> None:
    """An elliptic beam, the same in all four quarters, given in parts of the circle."""

    def beam(degrees: Any) -> Any:
        return 100.0 + 40.0 * np.cos(2.0 * np.radians(degrees))

    candela = [[value, value] for value in beam(np.array(planes))]
    profile = parse_ies(ies([0, 90], planes, candela), HERE)
    around = np.arange(0, 361, 90)
    got = profile.intensity(np.full(5, 0.5), np.radians(around))
    np.testing.assert_allclose(got, beam(around), rtol=1e-6)
    # In between the file is linear in the angle.
    turned = np.radians([45.0, 135.0, 225.0, 315.0])
    np.testing.assert_allclose(profile.intensity(np.full(4, 0.5), turned), 100.0, rtol=1e-6)


def test_a_half_circle_is_mirrored_and_not_repeated() -> None:
    """Light to one side only: 0 to 180 mirrors at the plane of 0, 90 to 270 at that of 90."""
    to_x = parse_ies(ies([0, 90], [0, 90, 180], [[9, 9], [5, 5], [1, 1]]), HERE)
    to_minus_x = parse_ies(ies([0, 90], [90, 180, 270], [[1, 1], [5, 5], [9, 9]]), HERE)
    angles = np.radians([0.0, 90.0, 180.0, 270.0])
    down = np.full(4, 0.5)
    np.testing.assert_allclose(to_x.intensity(down, angles), [9, 5, 1, 5])
    np.testing.assert_allclose(to_minus_x.intensity(down, angles), [5, 1, 5, 9])


def test_directions_that_the_file_leaves_out_are_dark() -> None:
    up = parse_ies(ies([90, 180], [0], [7, 7]), HERE)
    found = up.intensity(np.radians([0.0, 80.0, 100.0]), np.zeros(3))
    np.testing.assert_allclose(found, [0, 0, 7])


def test_old_and_odd_files_are_read() -> None:
    text = ies([0, 90], [0], [100, 50], head="Acme lamp, 1984\n", tilt="INCLUDE\n1\n2\n0 90\n1 .9")
    assert parse_ies(text.replace(" ", ",").replace("\n", "\r\n"), HERE).peak == 100.0


GOOD = ies([0, 90], [0], [123, 50])
BROKEN = {
    "empty": ("", "TILT: is missing"),
    "other": ("\x89PNG\r\n\x1a\n", "TILT: is missing"),
    "tilt file": (GOOD.replace("NONE", "other.tlt"), "TILT: 'other.tlt' is not NONE or INCLUDE"),
    "cut": (GOOD[:-3], "candela values: the file ends after 1 of 2"),
    "word": (GOOD.replace("123", "many"), "candela values: 'many' is no number"),
    "nan": (GOOD.replace("123", "nan"), "candela values: 'nan' is not finite"),
    "huge": (GOOD.replace("123", "1e999"), "candela values: '1e999' is not finite"),
    "negative": (GOOD.replace("123", "-1"), "candela values: are negative"),
    "dark": (ies([0, 90], [0], [0, 0]), "candela values: are all 0"),
    "type": (ies([0, 90], [0], [1, 1], kind=2), "photometric type: 2 is not 1 (type C)"),
    "descending": (ies([90, 0], [0], [1, 1]), "vertical angles: do not ascend"),
    "beyond": (ies([0, 200], [0], [1, 1]), "vertical angles: are not within 0 to 180 degrees"),
    "part": (ies([0, 90], [0, 60], [1, 1, 1, 1]), "horizontal angles: 0 to 60 is not"),
    "count": (GOOD.replace("2 1 1 2", "2.5 1 1 2"), "vertical angles: 2.5 is not 1 to 1000"),
    "many": (GOOD.replace("2 1 1 2", "9999999 1 1 2"), "vertical angles: 1e+07 is not 1 to 1000"),
    "multiplier": (ies([0, 90], [0], [1, 1], factors="1 1 0"), "multiplier: with the ballast"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_broken_files_are_refused_in_one_line(tmp_path: Path, case: str) -> None:
    text, reason = BROKEN[case]
    path = tmp_path / "lamp.ies"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError) as refused:
        read_ies(path)
    assert str(refused.value).startswith(f"{path}: {reason}")
    assert "\n" not in str(refused.value)


def test_whatever_is_cut_off_or_changed_is_read_or_refused() -> None:
    rng = np.random.default_rng(7)
    for _ in range(300):
        raw = bytearray(GOOD.encode())
        for place in rng.integers(0, len(raw), rng.integers(1, 4)):
            raw[place] = rng.integers(0, 256)
        text = raw.decode("latin-1")[: rng.integers(1, 2 * len(raw))]
        try:
            found = parse_ies(text, HERE)
        except InputError:
            continue
        assert isinstance(found, LightProfile)
        assert np.isfinite(found.image(4, 8)).all()


@pytest.mark.parametrize(
    ("field", "value", "reason"),
    [
        ("intensity", -1.0, "is negative"),
        ("intensity", math.nan, "is not finite"),
        ("color", np.array([1, -1, 0], np.float32), "is negative"),
        ("position", np.array([0, np.inf, 0], np.float32), "is not finite"),
        ("direction", np.zeros(3, np.float32), "has length 0"),
        ("range", 0.0, "is not positive"),
        ("range", math.nan, "is not positive"),
        ("source_radius", -0.1, "is negative"),
        ("inner_angle", 1.0, "outer_angle: is not between inner_angle and a right angle"),
        ("temperature", 400.0, "is not 1000 to 40000 K"),
    ],
)
def test_lights_that_can_t_be_are_refused(field: str, value: Any, reason: str) -> None:
    with pytest.raises(InputError, match=reason) as refused:
        checked(replace(LAMP, **{field: value}))
    assert "light 'lamp'" in str(refused.value)
    assert checked(LAMP) is LAMP


def test_a_profile_s_axis_is_across_the_direction() -> None:
    np.testing.assert_allclose(LAMP.profile_axis, [1, 0, 0], atol=1e-6)
    level = replace(LAMP, direction=np.array([0, 0, -1], np.float32))
    np.testing.assert_allclose(level.profile_axis, [1, 0, 0], atol=1e-6)
    turned = replace(level, roll=math.pi / 2)
    np.testing.assert_allclose(turned.profile_axis, [0, 1, 0], atol=1e-6)
