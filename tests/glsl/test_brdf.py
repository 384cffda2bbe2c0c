"""The slides' shading formulas against numpy. SH-02 SH-03 SH-04"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.gpu.device import Device
from formulas import MIRRORED_BY_ROUGH_DIELECTRIC, environment_brdf
from glsl.harness import run_glsl

Array = npt.NDArray[Any]
BRDF = ["lib/brdf.glsl"]
POWERS = np.exp2(np.linspace(-1, 18, 77))


def unit(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def lobe_angle(power: Array) -> Array:
    """acos(pow(Threshold, 1 / BlinnPhongSpecularPower))"""
    return np.arccos(np.power(0.04, 1.0 / power))


def slide_light_specular(n: Array, h: Array, lambert: Array, cos_angle: Array) -> Array:
    """[Mittring12 "Gaussian Specular"], line by line, in float64."""
    dot = np.clip(np.sum(n * h, axis=-1), 0.0, 1.0)
    norm_angle = (dot - 1.0) / (cos_angle - 1.0)
    return np.exp(-norm_angle * norm_angle) * lambert


def test_every_code_of_specular_power_survives_a_round_trip(device: Device) -> None:
    codes = np.arange(256)
    body = "specular_power_encode(specular_power_decode(float(code) / 255.0)) * 255.0"
    back = run_glsl(device, BRDF, body, {"code": codes})
    np.testing.assert_array_equal(np.rint(back), codes)
    assert np.abs(back - codes).max() < 1e-2


def test_specular_power_codes_are_the_slides(device: Device) -> None:
    encoded = run_glsl(device, BRDF, "specular_power_encode(power)", {"power": POWERS})
    np.testing.assert_allclose(encoded, (np.log2(POWERS) + 1) / 19, atol=2e-6)
    codes = np.arange(256) / 255
    decoded = run_glsl(device, BRDF, "specular_power_decode(code)", {"code": codes})
    np.testing.assert_allclose(decoded, np.exp2(codes * 19 - 1), rtol=2e-5)


def test_the_top_code_is_pixel_sharp_on_a_far_sphere(device: Device) -> None:
    """The slide's "far sphere of width 1000 pixel": its normal turns by 1 / 500 rad a pixel at the
    centre, the mirrored ray by twice that. The top code's lobe is a few pixels wide, not tens."""
    cone = run_glsl(
        device, BRDF, "specular_cone_half_angle(specular_power_decode(code))", {"code": np.ones(1)}
    )
    assert 2.0 * cone[0] < 4.0 * 4.0 / 1000.0
    assert 2.0 * cone[0] > 4.0 / 1000.0 / 4.0


@pytest.mark.parametrize("tilt", [0.2, 1.0, 3.0])
def test_gaussian_specular_is_the_slides_formula(device: Device, tilt: float) -> None:
    rng = np.random.default_rng(7)
    n = unit(rng.normal(size=(77, 3)))
    angle = lobe_angle(POWERS) * tilt * rng.uniform(0.1, 1.0, 77)
    side = unit(np.cross(n, rng.normal(size=(77, 3))))
    h = n * np.cos(angle)[:, None] + side * np.sin(angle)[:, None]
    lambert = rng.uniform(0.1, 1.0, 77)
    want = slide_light_specular(n, h, lambert, np.power(0.04, 1.0 / POWERS))
    got = run_glsl(
        device,
        BRDF,
        "gaussian_specular_lobe(n, h, lambert, specular_lobe_angle(power))",
        {"n": n, "h": h, "lambert": lambert, "power": POWERS},
    )
    np.testing.assert_allclose(got, want, rtol=5e-3, atol=1e-5)


def test_the_lobe_angle_keeps_its_precision_at_sharp_powers(device: Device) -> None:
    got = run_glsl(device, BRDF, "specular_lobe_angle(power)", {"power": POWERS})
    np.testing.assert_allclose(got, lobe_angle(POWERS), rtol=1e-3)


def test_an_area_light_widens_the_lobe_by_its_own_angle(device: Device) -> None:
    """LightAreaAngle = atan(AreaLightFraction / LightDistance); cos(ACos + LightAreaAngle)"""
    rng = np.random.default_rng(3)
    radius, distance = rng.uniform(0, 2, 64), rng.uniform(0.5, 5, 64)
    power = np.exp2(rng.uniform(4, 16, 64))
    area = np.arctan(radius / distance)
    wide = lobe_angle(power) + area
    angle = wide * rng.uniform(0, 1.2, 64)
    n = np.tile([0.0, 0.0, 1.0], (64, 1))
    h = np.stack([np.sin(angle), np.zeros(64), np.cos(angle)], axis=-1)
    want = slide_light_specular(n, h, np.full(64, 0.8), np.cos(wide)) / (wide**2 * 10.0)
    got = run_glsl(
        device,
        BRDF,
        "gaussian_specular(n, h, 0.8, power, light_area_angle(radius, light_m))",
        {"n": n, "h": h, "power": power, "radius": radius, "light_m": distance},
    )
    np.testing.assert_allclose(got, want, rtol=5e-3, atol=1e-5)


def highlight_energy(device: Device, power: float, area: float) -> float:
    """Integral of the specular term over all half vectors' mirrored directions, light at zenith."""
    h_angle = np.linspace(0.0, np.pi / 4, 4001)
    h = np.stack([np.sin(h_angle), np.zeros_like(h_angle), np.cos(h_angle)], axis=-1)
    n = np.tile([0.0, 0.0, 1.0], (len(h), 1))
    values = run_glsl(
        device, BRDF, f"gaussian_specular(n, h, 1.0, {power}, {area})", {"n": n, "h": h}
    )
    theta = 2.0 * h_angle
    ring = values * 2.0 * np.pi * np.sin(theta)
    return float(((ring[1:] + ring[:-1]) / 2.0 * np.diff(theta)).sum())


@pytest.mark.parametrize("power", [100.0, 1000.0, 20000.0])
def test_the_highlight_keeps_its_energy_as_the_light_grows(device: Device, power: float) -> None:
    """The integral of exp(-(h / A)^4) over the mirrored sphere is 2 pi^1.5 A^2 for small lobes A,
    and the slide divides by 10 A^2; wide ones leave that approximation slowly."""
    slide = 2.0 * np.pi**1.5 / 10.0
    energies = [highlight_energy(device, power, area) for area in (0.0, 0.05, 0.2)]
    np.testing.assert_allclose(energies, slide, rtol=0.08)
    assert max(energies) < 1.01 * slide


def test_roughness_becomes_the_power_of_the_same_width(device: Device) -> None:
    roughness = np.linspace(0.05, 1.0, 40)
    power = run_glsl(device, BRDF, "specular_power_from_roughness(r)", {"r": roughness})
    want = np.clip(2.0 / roughness**4 - 2.0, 0.5, 2.0**18)
    np.testing.assert_allclose(power, want, rtol=1e-4)
    inside = (want > 0.5) & (want < 2.0**18)
    back = run_glsl(device, BRDF, "roughness_from_specular_power(p)", {"p": want[inside]})
    np.testing.assert_allclose(back, roughness[inside], rtol=1e-3)


def ggx_environment_share(roughness: float, n_o_v: float, f0: float) -> float:
    """Directional albedo of GGX with Smith's height-correlated shadowing and Schlick's Fresnel, by
    importance sampling half vectors on a fixed grid [Karis13 "Environment BRDF"]."""
    alpha = roughness**2
    u, v = np.meshgrid((np.arange(256) + 0.5) / 256, (np.arange(64) + 0.5) / 64)
    cosine = np.sqrt((1 - u) / (1 + (alpha**2 - 1) * u))
    sine, phi = np.sqrt(1 - cosine**2), 2 * np.pi * v
    view = np.array([np.sqrt(1 - n_o_v**2), 0.0, n_o_v])
    v_o_h = view[0] * sine * np.cos(phi) + view[2] * cosine
    n_o_l = 2 * v_o_h * cosine - n_o_v
    lit = (n_o_l > 0) & (v_o_h > 0)
    n_o_l, v_o_h, cosine = n_o_l[lit], v_o_h[lit], cosine[lit]
    smith_v = n_o_l * np.sqrt(n_o_v**2 * (1 - alpha**2) + alpha**2)
    smith_l = n_o_v * np.sqrt(n_o_l**2 * (1 - alpha**2) + alpha**2)
    visibility = 2 * n_o_l * n_o_v / (smith_v + smith_l)
    fresnel = f0 + (1 - f0) * (1 - v_o_h) ** 5
    return float((fresnel * visibility * v_o_h / (cosine * n_o_v)).sum() / lit.size)


def test_the_environment_term_is_ggx_s_share_of_a_uniform_sky(device: Device) -> None:
    grid = [
        (r, c, f) for r in (0.1, 0.3, 0.5, 0.8, 1.0) for c in (0.2, 0.5, 0.9) for f in (0.04, 0.8)
    ]
    want = np.array([ggx_environment_share(*point) for point in grid])
    columns = np.array(grid)
    got = run_glsl(
        device,
        BRDF,
        "environment_brdf(vec3(f0), r, c).g",
        {"r": columns[:, 0], "c": columns[:, 1], "f0": columns[:, 2]},
    )
    assert np.abs(got - want).max() < 0.05
    assert np.abs(got - want).mean() < 0.008


@pytest.mark.parametrize("f0", [0.04, 0.5, 1.0])
def test_the_mirrored_share_is_the_environments_mean(device: Device, f0: float) -> None:
    """Over the hemisphere, by cosine: polynomials 0.007 and 0.004 off at most."""
    roughness = np.linspace(0.0, 1.0, 21)
    got = run_glsl(device, BRDF, "mirrored_share(vec3(f0), r)",
                   {"f0": np.full(21, f0), "r": roughness}, "vec3")[:, 0]  # fmt: skip
    cosines = (np.arange(400) + 0.5) / 400
    shares = environment_brdf(f0, roughness[:, None], cosines[None])
    wanted = (2.0 * cosines * shares).mean(axis=1)
    np.testing.assert_allclose(got, wanted, atol=0.011)
    if f0 == 0.04:
        assert got[-1] == pytest.approx(MIRRORED_BY_ROUGH_DIELECTRIC, abs=5e-4)
