"""Lighting models against numpy, and a white furnace around each. SH-05"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from formulas import environment_brdf
from glsl.harness import run_glsl

Array = npt.NDArray[Any]
INCLUDES = ["lib/lighting_models.glsl"]
MODELS = {name: int(layouts().constant(f"LIGHTING_{name}")) for name in
          ("DEFAULT", "SUBSURFACE", "CLOTH")}  # fmt: skip
ROUGHNESS = (0.2, 0.35, 0.5, 0.7, 1.0)
COSINES = (0.1, 0.3, 0.6, 1.0)
MOST = 1.02
"""What a white furnace may return: the issue's own bound."""


def sphere_grid(rings: int) -> tuple[Array, Array]:
    """Directions (N, 3) of equal solid angle, and that angle."""
    z = (np.arange(rings) + 0.5) / rings * 2 - 1
    turn = (np.arange(2 * rings) + 0.5) / (2 * rings) * 2 * np.pi
    z, turn = (grid.reshape(-1) for grid in np.meshgrid(z, turn))
    sine = np.sqrt(1 - z * z)
    directions = np.stack([sine * np.cos(turn), sine * np.sin(turn), z], axis=-1)
    return directions, np.full(len(directions), 4 * np.pi / len(directions))


def mirrored_grid(to_eye: Array, width: float, side: int) -> tuple[Array, Array]:
    """Directions (N, 3) around the mirrored eye, denser than its lobe of half vectors of so many
    radians, and their solid angles: those of the half vectors times 4 |v.h|."""
    theta = (np.arange(side) + 0.5) / side * width
    turn = (np.arange(side) + 0.5) / side * 2 * np.pi
    theta, turn = (grid.reshape(-1) for grid in np.meshgrid(theta, turn))
    h = np.stack(
        [np.sin(theta) * np.cos(turn), np.sin(theta) * np.sin(turn), np.cos(theta)], axis=-1
    )
    cosine = h @ to_eye
    angle = np.sin(theta) * (width / side) * (2 * np.pi / side) * 4 * np.maximum(cosine, 0)
    return 2 * cosine[:, None] * h - to_eye, angle


def eye_at(cosine: float) -> Array:
    return np.array([np.sqrt(1 - cosine**2), 0.0, cosine])


def reflected(
    device: Device, model: str, roughness: float, to_eye: Array, to_light: Array, white: str
) -> Array:
    """(N, 3): diffuse, specular and transmitted radiance of lights of irradiance 1.

    white: the part of the surface that is; the others are black.
    """
    rows = len(to_light)
    given = {
        "to_light": to_light.astype(np.float32),
        "to_eye": np.tile(to_eye.astype(np.float32), (rows, 1)),
    }
    colors = {
        "dielectric": "vec3(1.0), vec3(0.04)",
        "metal": "vec3(0.0), vec3(1.0)",
        "cloth": "vec3(1.0), vec3(1.0)",
        "skin": "vec3(0.4), vec3(0.04)",
    }[white]
    through = "vec3(0.6)" if white == "skin" else "vec3(0.0)"
    body = f"""
    float power = specular_power_from_roughness({roughness});
    ShadingPoint p = shading_point(vec3(0.0), vec3(0.0, 0.0, 1.0), to_eye, {colors}, power,
                                   {through}, {MODELS[model]}u);
    DirectLight d = reflect_sample(p, to_light, vec3(1.0), 0.0);
    result = vec3(d.diffuse.g, d.specular.g, transmit_sample(p, to_light, vec3(1.0)).g);
    """
    return run_glsl(device, INCLUDES, body, given, "vec3").astype(np.float64)


FURNACES = [("DEFAULT", "dielectric"), ("DEFAULT", "metal"), ("SUBSURFACE", "skin"),
            ("CLOTH", "cloth")]  # fmt: skip


def furnace(device: Device, model: str, white: str, roughness: float, cosine: float) -> float:
    """Radiance towards the eye under a uniform sky of radiance 1 made of many lights."""
    to_eye = eye_at(cosine)
    around, angle = sphere_grid(96)
    spread = reflected(device, model, roughness, to_eye, around, white)
    broad = (spread[:, 0] + spread[:, 2]) @ angle
    if model == "CLOTH":
        return float(broad + spread[:, 1] @ angle)
    power = min(max(2 / roughness**4 - 2, 0.5), 262144)
    lobe = np.arccos(0.04 ** (1 / power))
    near, angle = mirrored_grid(to_eye, min(2.5 * lobe, np.pi / 2), 160)
    return float(broad + reflected(device, model, roughness, to_eye, near, white)[:, 1] @ angle)


@pytest.mark.parametrize(("model", "white"), FURNACES)
def test_a_white_furnace_returns_no_more_than_arrives(
    device: Device, model: str, white: str
) -> None:
    """docs/materials.md states the figures below 1."""
    table = np.array([[furnace(device, model, white, r, c) for c in COSINES] for r in ROUGHNESS])
    print(f"\n{model} {white}\n{table.round(3)}")
    assert table.max() <= MOST
    least = {"dielectric": 0.75, "metal": 0.0, "skin": 0.75, "cloth": 0.6}[white]
    assert table[:, 1:].min() > least


@pytest.mark.parametrize("model", MODELS)
def test_under_an_even_sky_nothing_is_lost_or_won(device: Device, model: str) -> None:
    """The environment's path: what is mirrored and what is left for the rest add up to 1."""
    roughness, cosine = (grid.reshape(-1) for grid in np.meshgrid(ROUGHNESS, COSINES))
    given = {"r": roughness.astype(np.float32), "c": cosine.astype(np.float32)}
    body = f"""
    vec3 mirrored = mirrored_share({MODELS[model]}u, vec3(0.5), r, c);
    result = (mirrored + diffuse_hold(vec3(0.7), vec3(0.3), mirrored)).g;
    """
    np.testing.assert_allclose(run_glsl(device, INCLUDES, body, given), 1.0, atol=1e-5)
    body = f"mirrored_share({MODELS[model]}u, vec3(0.5), r, c).g"
    got = run_glsl(device, INCLUDES, body, given)
    if model != "CLOTH":
        np.testing.assert_allclose(got, environment_brdf(0.5, roughness, cosine), atol=1e-5)


def test_dim_surfaces_keep_their_albedo(device: Device) -> None:
    given = {"albedo": np.linspace(0, 0.9, 10).astype(np.float32)}
    got = run_glsl(device, INCLUDES, "diffuse_hold(vec3(albedo), vec3(0.0), vec3(0.04)).g", given)
    np.testing.assert_array_equal(got, 1.0)


def numpy_transmitted(n_o_l: Array, through: Array) -> Array:
    wrapped = np.clip((0.5 - n_o_l) / 1.5**2, 0, 1)
    forward = 0.5 * 13.0 * np.maximum(through, 0) ** 12
    return np.asarray(0.65 * wrapped + 0.35 * forward)


def test_light_through_a_surface_is_an_albedo(device: Device) -> None:
    rng = np.random.default_rng(1)
    n_o_l, through = rng.uniform(-1, 1, (2, 500)).astype(np.float32)
    given = {"a": n_o_l, "b": through}
    got = run_glsl(device, INCLUDES, "transmitted_share(a, b)", given)
    np.testing.assert_allclose(got, numpy_transmitted(n_o_l, through), rtol=2e-5, atol=1e-6)
    directions, angle = sphere_grid(200)
    total = numpy_transmitted(directions[:, 2], directions @ eye_at(0.7)) @ angle / np.pi
    assert total == pytest.approx(1.0, abs=2e-3)


def numpy_cloth(n_o_h: Array, n_o_l: Array, n_o_v: Array | float, roughness: float) -> Array:
    """Charlie's distribution [Estevez17] and Neubelt's visibility [Neubelt13], times the cosine."""
    power = 1.0 / roughness**2
    sine = np.sqrt(np.maximum(1 - n_o_h**2, 1e-6))
    visibility = 1 / (4 * (n_o_l + n_o_v - n_o_l * n_o_v))
    return np.asarray((2 + power) * sine**power / (2 * np.pi) * visibility * n_o_l)


@pytest.mark.parametrize("roughness", [0.3, 0.6, 0.9])
def test_cloth_is_the_papers_sheen(device: Device, roughness: float) -> None:
    rng = np.random.default_rng(2)
    h, light, view = rng.uniform(0.02, 1, (3, 500)).astype(np.float32)
    body = f"cloth_specular(h, l, v, {roughness})"
    got = run_glsl(device, INCLUDES, body, {"h": h, "l": light, "v": view})
    np.testing.assert_allclose(got, numpy_cloth(h, light, view, roughness), rtol=2e-3, atol=1e-6)


@pytest.mark.parametrize("roughness", [0.3, 0.5, 0.7, 0.95])
def test_the_fit_of_cloth_s_albedo_is_its_integral(device: Device, roughness: float) -> None:
    directions, angle = sphere_grid(300)
    upper = directions[:, 2] > 0
    to_light, angle = directions[upper], angle[upper]
    cosines = np.array([0.05, 0.2, 0.5, 0.8, 1.0])
    want = []
    for cosine in cosines:
        h = to_light + eye_at(cosine)
        h /= np.linalg.norm(h, axis=1, keepdims=True)
        want.append(numpy_cloth(h[:, 2], to_light[:, 2], cosine, roughness) @ angle)
    given = {"c": cosines.astype(np.float32)}
    got = run_glsl(device, INCLUDES, f"cloth_albedo({roughness}, c)", given)
    np.testing.assert_allclose(got, want, atol=0.02)
