"""Light through bodies of glass against the optics of panes and balls. SH-06"""

from __future__ import annotations

import numpy as np
import pytest

from elemental.gpu.device import Device
from glsl.harness import run_glsl

INCLUDES = ["lib/refraction.glsl"]
ANGLES = np.radians([0.0, 5.0, 20.0, 40.0, 60.0, 75.0])


def rays(count: int) -> dict[str, np.ndarray]:
    """Rays that travel to -z and fall on a surface at the origin, turned by ANGLES."""
    direction = np.stack([np.sin(ANGLES), np.zeros(count), -np.cos(ANGLES)], axis=1)
    return {"d": direction, "n": np.tile([0.0, 0.0, 1.0], (count, 1)), "p": np.zeros((count, 3))}


def refracted(device: Device, member: str, ior: float, thickness: float, roundness: float):  # type: ignore[no-untyped-def]
    body = f"refract_through(p, d, n, {ior}, {thickness}, {roundness}).{member}"
    kind = "float" if member == "path_m" else "vec3"
    return run_glsl(device, INCLUDES, body, rays(len(ANGLES)), kind)


@pytest.mark.parametrize("ior", [1.33, 1.5, 2.4])
def test_a_pane_shifts_light_and_does_not_turn_it(device: Device, ior: float) -> None:
    """Shift across the ray: d sin(i - t) / cos(t)."""
    inside = np.arcsin(np.sin(ANGLES) / ior)
    direction = refracted(device, "direction", ior, 0.5, 0.0)
    np.testing.assert_allclose(direction, rays(len(ANGLES))["d"], atol=2e-3)
    origin = refracted(device, "origin", ior, 0.5, 0.0)
    np.testing.assert_allclose(origin[:, 2], -0.5, atol=1e-5)
    across = np.stack([np.cos(ANGLES), np.zeros(len(ANGLES)), np.sin(ANGLES)], axis=1)
    shift = -np.sum(origin * across, axis=1)
    np.testing.assert_allclose(shift, 0.5 * np.sin(ANGLES - inside) / np.cos(inside), atol=1e-5)
    path = refracted(device, "path_m", ior, 0.5, 0.0)
    np.testing.assert_allclose(path, 0.5 / np.cos(inside), rtol=1e-5)


@pytest.mark.parametrize("ior", [1.33, 1.5, 2.4])
def test_a_ball_turns_light_twice_by_the_same_angle(device: Device, ior: float) -> None:
    """Deviation 2 (i - t); light leaves at the ball's surface, after a chord of 2 r cos(t)."""
    inside = np.arcsin(np.sin(ANGLES) / ior)
    direction = refracted(device, "direction", ior, 0.6, 1.0)
    turned = np.arctan2(direction[:, 0], -direction[:, 2]) - ANGLES
    np.testing.assert_allclose(-turned, 2.0 * (ANGLES - inside), atol=2e-3)
    origin = refracted(device, "origin", ior, 0.6, 1.0)
    from_centre = np.linalg.norm(origin - [0.0, 0.0, -0.3], axis=1)
    np.testing.assert_allclose(from_centre, 0.3, rtol=1e-4)
    path = refracted(device, "path_m", ior, 0.6, 1.0)
    np.testing.assert_allclose(path, 0.6 * np.cos(inside), rtol=1e-4)


def test_both_faces_of_a_pane_mirror(device: Device) -> None:
    """The sum over all ways to and fro: R + (1 - R)² k² R (1 + k² R² + …), of clear glass
    2 R / (1 + R), and of what passes (1 - R)² k (1 + k² R² + …)."""
    faces = np.array([0.0, 0.04, 0.2, 0.6, 0.95])
    kept = np.array([1.0, 0.8, 0.3])
    r, k = (grid.ravel() for grid in np.meshgrid(faces, kept))
    given = {"r": np.repeat(r[:, None], 3, axis=1), "k": np.repeat(k[:, None], 3, axis=1)}
    rounds = sum((k * r) ** (2 * n) for n in range(200))
    for member, want in (
        ("mirrored", r + (1 - r) ** 2 * k**2 * r * rounds),
        ("passes", (1 - r) ** 2 * k * rounds),
    ):
        got = run_glsl(device, INCLUDES, f"pane_shares(r, k).{member}", given, "vec3")
        np.testing.assert_allclose(got, np.repeat(want[:, None], 3, axis=1), rtol=2e-4, atol=1e-6)


def test_a_thin_wall_leaves_light_as_it_is(device: Device) -> None:
    np.testing.assert_allclose(refracted(device, "direction", 1.5, 0.0, 1.0),
                               rays(len(ANGLES))["d"], atol=1e-6)  # fmt: skip
    assert not refracted(device, "origin", 1.5, 0.0, 1.0).any()


def test_dielectrics_reflect_by_their_index(device: Device) -> None:
    ior = np.array([1.0, 1.33, 1.5, 2.4])
    got = run_glsl(device, INCLUDES, "reflectance_of_ior(ior)", {"ior": ior})
    np.testing.assert_allclose(got, ((ior - 1) / (ior + 1)) ** 2, rtol=1e-5)


def test_absorption_leaves_the_colour_after_its_distance(device: Device) -> None:
    """KHR_materials_volume: attenuationColor ^ (path / attenuationDistance)"""
    color = np.array([[0.9, 0.5, 0.1], [1.0, 1.0, 1.0]])
    path = np.array([0.3, 2.0])
    body = "exp(-absorption_of(c, 0.7) * path)"
    got = run_glsl(device, INCLUDES, body, {"c": color, "path": path}, "vec3")
    np.testing.assert_allclose(got, color ** (path[:, None] / 0.7), rtol=1e-4)
    got = run_glsl(device, INCLUDES, "absorption_of(c, 0.0)", {"c": color}, "vec3")
    assert not got.any()


def test_how_round_a_body_is_shows_in_its_curvature(device: Device) -> None:
    thickness = np.array([0.6, 0.6, 0.03, 0.6])
    radius = np.array([0.3, 1e9, 0.3, 0.1])
    got = run_glsl(device, INCLUDES, "roundness_of(t, r)", {"t": thickness, "r": radius})
    np.testing.assert_allclose(got, [1.0, 0.0, 0.05, 1.0], atol=1e-5)


def test_rough_glass_scatters_less_than_it_mirrors(device: Device) -> None:
    """Nothing of an index of 1; a facet that turns by h turns a mirrored ray by 2 h."""
    lobe = np.array([0.1, 0.1, 0.4])
    ior = np.array([1.0, 1.5, 1.5])
    got = run_glsl(device, INCLUDES, "refracted_half_angle(lobe, ior)", {"lobe": lobe, "ior": ior})
    np.testing.assert_allclose(got, lobe / 2 * (ior - 1) * np.sqrt(2), rtol=1e-5)
