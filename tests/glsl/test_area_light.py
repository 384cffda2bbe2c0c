"""Light from parallelograms and balls against closed forms and sums. GI-15"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.gpu.device import Device
from elemental.passes.area_lights import pack_area_lights
from elemental.scene.area_lights import AreaLight
from glsl.harness import run_glsl

Array = npt.NDArray[Any]
LIB = ["lib/area_light.glsl"]
UP = np.array([0.0, 1.0, 0.0])


def face(
    corner: tuple[float, float, float],
    u: tuple[float, float, float],
    v: tuple[float, float, float],
    radiance: float = 1.0,
    both_sides: bool = False,
) -> AreaLight:
    f4 = [np.array(x, np.float32) for x in (corner, u, v)]
    return AreaLight(0, *f4, np.full(3, radiance, np.float32), both_sides)


def lamp(height: float, side: float, **fields: Any) -> AreaLight:
    """A square over the origin that shines down."""
    h = side / 2
    return face((-h, height, -h), (side, 0, 0), (0, 0, side), **fields)


def irradiance(device: Device, lights: list[AreaLight], p: Array, normal: Array) -> Array:
    p, normal = np.broadcast_arrays(np.atleast_2d(p), np.atleast_2d(normal))
    inputs = {"p": p.astype(np.float32), "n": normal.astype(np.float32)}
    params = {"AreaLights": pack_area_lights(lights)}
    return run_glsl(device, LIB, "area_irradiance(p, n)", inputs, "vec3", params=params)[:, 0]


def summed(light: AreaLight, p: Array, normal: Array, cells: int = 400) -> float:
    """The same by a sum over small pieces."""
    s = (np.arange(cells) + 0.5) / cells
    u, v = (e.astype(float) for e in (light.edge_u, light.edge_v))
    points = light.corner + s[:, None, None] * u + s[None, :, None] * v - p
    front = np.cross(u, v)
    squared = (points**2).sum(-1)
    direction = points / np.sqrt(squared)[..., None]
    facing = -direction @ front
    facing = np.abs(facing) if light.both_sides else np.maximum(facing, 0.0)
    return float((np.maximum(direction @ normal, 0.0) * facing / squared).sum() / cells**2)


@pytest.mark.parametrize("height", [0.01, 0.1, 0.5, 1.0, 4.0])
def test_under_the_middle_of_a_square(device: Device, height: float) -> None:
    """Four times the corner's form factor [Howell, Catalog of Radiation Configuration Factors B-3],
    times pi."""
    a = 0.5 / height
    root = np.sqrt(1.0 + a * a)
    expected = np.pi * 4.0 / np.pi * a / root * np.arctan(a / root)
    found = irradiance(device, [lamp(height, 1.0)], np.zeros(3), UP)
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_any_point_and_normal_and_the_horizon(device: Device) -> None:
    rng = np.random.default_rng(4)
    p = rng.uniform(-1.5, 1.5, (60, 3))
    normals = rng.normal(size=(60, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    skewed = face((-0.4, 0.3, -0.5), (0.9, 0.4, 0.1), (0.3, -0.2, 0.8))
    for both in (False, True):
        light = AreaLight(0, skewed.corner, skewed.edge_u, skewed.edge_v, skewed.radiance, both)
        found = irradiance(device, [light], p, normals)
        wanted = [summed(light, a, n) for a, n in zip(p, normals, strict=True)]
        np.testing.assert_allclose(found, wanted, rtol=0.01, atol=0.003)
    assert min(np.count_nonzero(found), np.count_nonzero(found == 0.0)) > 3


def test_its_own_face_gets_nothing(device: Device) -> None:
    p = np.array([[0.1, 1.0 + offset, 0.2] for offset in (-1e-4, 0.0, 1e-4)])
    for normal in (UP, -UP):
        assert irradiance(device, [lamp(1.0, 1.0, both_sides=True)], p, normal).max() == 0.0


def test_the_back_is_dark_unless_both_sides_emit(device: Device) -> None:
    above = np.array([0.0, 2.0, 0.0])
    assert irradiance(device, [lamp(1.0, 1.0)], above, -UP) == 0.0
    both = irradiance(device, [lamp(1.0, 1.0, both_sides=True)], above, -UP)
    below = irradiance(device, [lamp(1.0, 1.0)], np.zeros(3), UP)
    np.testing.assert_allclose(both, below, rtol=1e-5)


def ball(centre: tuple[float, float, float], radius: float, radiance: float = 1.0) -> AreaLight:
    none = np.zeros(3, np.float32)
    edge = np.array([radius, 0, 0], np.float32)
    return AreaLight(
        0, np.array(centre, np.float32), edge, none, np.full(3, radiance), False, is_ball=True
    )


def test_a_ball_above_the_horizon(device: Device) -> None:
    """pi sin^2(half angle) by the cosine to its centre, from afar and from near."""
    rng = np.random.default_rng(7)
    centre, radius = np.array([0.2, 0.3, -0.1]), 0.4
    away = rng.normal(size=(80, 3))
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    distance = radius * rng.uniform(1.2, 9.0, 80)[:, None]
    p = centre + away * distance
    normal = -away + 0.15 * rng.normal(size=(80, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    sine = (radius / distance)[:, 0]
    cosine = -(away * normal).sum(1)
    whole = cosine > sine
    assert whole.sum() > 50
    found = irradiance(device, [ball(tuple(centre), radius)], p, normal)
    np.testing.assert_allclose(found[whole], (np.pi * sine**2 * cosine)[whole], rtol=0.02)


def test_a_ball_that_the_horizon_cuts(device: Device) -> None:
    """Against a sum over the directions in which it is seen."""
    rng = np.random.default_rng(8)
    directions = rng.normal(size=(400_000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    centre = np.array([0.0, 0.2, 1.0])
    found = irradiance(device, [ball(tuple(centre), 0.5)], np.zeros(3), UP)
    along = directions @ centre
    seen = (along > 0.0) & (centre @ centre - along**2 < 0.25)
    wanted = 4.0 * np.pi * np.mean(seen * np.maximum(directions[:, 1], 0.0))
    np.testing.assert_allclose(found, wanted, rtol=0.03)


def test_a_ball_is_dark_within_and_below_the_horizon(device: Device) -> None:
    p = np.array([[0, 0, 0], [0.3, 0, 0], [0, 0.5, 0], [0, 0.501, 0], [0, 2, 0]], float)
    found = irradiance(device, [ball((0, 0, 0), 0.5)], p, UP)
    np.testing.assert_array_equal(found, 0.0)
    below = irradiance(device, [ball((0, 0, 0), 0.5)], p[4], -UP)
    assert below[0] == pytest.approx(np.pi / 16.0, rel=0.01)


STRATA = """
vec4 stratum(vec3 p, vec3 n, int k) {
    AreaSample s = sample_area_lights(p, n, k);
    return vec4(s.point_ws, s.face < 0 ? -1.0 : s.irradiance.x);
}
"""


@pytest.mark.parametrize("count", [1, 2, 5])
def test_the_strata_share_the_irradiance(device: Device, count: int) -> None:
    """Their mean is the whole, and each face is looked at as often as its share says."""
    lights = [face((k, 1.0 + 0.2 * k, -0.5), (0.8, 0, 0), (0, 0, 1), 1.0 + k) for k in range(count)]
    p = np.array([0.3, 0.0, 0.1])
    inputs = {
        "p": np.tile(p, (9, 1)).astype(np.float32),
        "n": np.tile(UP, (9, 1)).astype(np.float32),
        "k": np.arange(9, dtype=np.int32),
    }
    params = {"AreaLights": pack_area_lights(lights)}
    found = run_glsl(
        device, LIB, "stratum(p, n, k)", inputs, "vec4", functions=STRATA, params=params
    )
    whole = irradiance(device, lights, p, UP)[0]
    np.testing.assert_allclose(found[:, 3].mean(), whole, rtol=1e-4)
    alone = np.array([irradiance(device, [light], p, UP)[0] for light in lights])
    looks = np.array([np.count_nonzero(found[:, 0] // 1 == k) for k in range(count)])
    assert np.abs(looks - 9 * alone / whole).max() < 1.0


LOBE = "area_lobe_radiance(p, n, d, a)"


def test_a_panel_wider_than_the_lobe_is_seen_at_its_own_radiance(device: Device) -> None:
    inputs = {
        "p": np.zeros((1, 3), np.float32), "n": UP[None].astype(np.float32),
        "d": UP[None].astype(np.float32), "a": np.full(1, 0.5, np.float32),
    }  # fmt: skip
    far = run_glsl(
        device, LIB, LOBE, inputs, "vec3",
        params={"AreaLights": pack_area_lights([lamp(10.0, 1.0, radiance=3.0)])},
    )  # fmt: skip
    # A small lamp on the axis: its solid angle by the lobe's effective one, 2 pi variance.
    np.testing.assert_allclose(far[0, 0], 3.0 * 0.01 / (2 * np.pi * 0.0625), rtol=0.03)


HIT = "hit(p, d, a)"
HIT_FUNCTION = """
vec4 hit(vec3 p, vec3 d, float a) {
    AreaHit h = hit_area_lights(p, d, a, 0.0, 0.1);
    return vec4(h.distance_m, h.share, h.radiance.x, 0);
}
"""


def test_a_ray_meets_the_nearest_face_that_it_points_at(device: Device) -> None:
    lights = [lamp(2.0, 1.0), lamp(1.0, 1.0)]
    inputs = {
        "p": np.array([[0, 0, 0], [0.5, 0, 0], [0.6, 0, 0], [0, 3, 0]], np.float32),
        "d": np.array([UP, UP, UP, -UP], np.float32),
        "a": np.full(4, 1e-4, np.float32),
    }
    params = {"AreaLights": pack_area_lights(lights)}
    found = run_glsl(device, LIB, HIT, inputs, "vec4", functions=HIT_FUNCTION, params=params)
    np.testing.assert_allclose(found[0, :2], [1.0, 1.0], rtol=1e-4)
    np.testing.assert_allclose(found[1, 1], 0.5, atol=0.01)  # along its edge
    assert found[2, 1] == 0.0  # beside it
    assert found[3, 1] == 0.0  # from behind


def test_a_ray_meets_a_round_ball(device: Device) -> None:
    """A thin cone at its true distance; a wide one is covered by the ratio of the discs."""
    x = np.array([0.0, 0.3, 0.48, 0.52, 0.0, 0.0])
    inputs = {
        "p": np.stack([x, 0 * x, 0 * x], 1).astype(np.float32),
        "d": np.tile(UP, (6, 1)).astype(np.float32),
        "a": np.array([1e-4] * 4 + [np.arctan(0.5), 1e-4], np.float32),
    }
    inputs["p"][5, 1] = 4.0  # behind
    params = {"AreaLights": pack_area_lights([ball((0, 2, 0), 0.5)])}
    found = run_glsl(device, LIB, HIT, inputs, "vec4", functions=HIT_FUNCTION, params=params)
    np.testing.assert_allclose(found[:3, 1], 1.0, atol=1e-4)
    np.testing.assert_allclose(found[:3, 0], 2.0 - np.sqrt(0.25 - x[:3] ** 2), rtol=1e-3)
    np.testing.assert_array_equal(found[[3, 5], 1], 0.0)
    assert found[4, 1] == pytest.approx(0.25, rel=1e-3)


@pytest.mark.parametrize("tiles", [1, 2, 4, 8])
def test_tiles_of_a_panel_are_seen_as_the_panel(device: Device, tiles: int) -> None:
    width = 3.0 / tiles
    lights = [
        face((-1.5 + k * width, 1.0, -1.5), (width, 0, 0), (0, 0, 3), 2.0) for k in range(tiles)
    ]
    inputs = {
        "p": np.array([[0, 0, 0], [1.4, 0, 0]], np.float32),
        "d": np.array([UP, UP], np.float32),
        "a": np.full(2, 0.6, np.float32),
    }
    params = {"AreaLights": pack_area_lights(lights)}
    found = run_glsl(device, LIB, HIT, inputs, "vec4", functions=HIT_FUNCTION, params=params)
    np.testing.assert_allclose(found[0, :3], [1.0, 1.0, 2.0], rtol=1e-4)
    inside = 0.5 + 0.1 / (2.0 * np.tan(0.6))
    np.testing.assert_allclose(found[1, 1], inside, rtol=1e-3)
