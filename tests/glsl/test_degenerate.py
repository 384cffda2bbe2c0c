"""Where a formula has no direction or divides by nothing, its result is a number still."""

from __future__ import annotations

import numpy as np
import pytest

from elemental.gpu.device import Device
from elemental.passes.area_lights import pack_area_lights
from glsl.harness import run_glsl
from glsl.test_area_light import LIB, lamp

ODD = np.array([np.nan, np.inf, -np.inf, -1.0, 0.0, 2.0, 1e6, 65504.0], np.float32)


@pytest.mark.parametrize("model", ["LIGHTING_DEFAULT", "LIGHTING_CLOTH"])
def test_a_bump_that_faces_a_light_straight_behind_it(device: Device, model: str) -> None:
    body = f"""
    ShadingPoint p = shading_point(vec3(0.0), normalize(vec3(0.6, 0.0, -0.8)), vec3(0.0, 0.0, 1.0),
                                   vec3(0.5), vec3(0.04), 32.0, vec3(0.0), {model});
    DirectLight d = reflect_sample(p, vec3(0.0, 0.0, -1.0), vec3(1.0), 0.0);
    result = d.diffuse + d.specular;
    """
    got = run_glsl(device, ["lib/lighting_models.glsl"], body, output="vec3", count=1)
    assert np.isfinite(got).all()
    assert (got >= 0.0).all()


def test_a_lobe_from_a_point_of_the_light_itself(device: Device) -> None:
    """One of the four at which it is looked at."""
    params = {"AreaLights": pack_area_lights([lamp(1.0, 2.0)])}
    body = (
        "area_lobe_radiance(vec3(-0.5, 1.0, -0.5), vec3(0, 1, 0), normalize(vec3(1, 0.5, 0)), 0.5)"
    )
    got = run_glsl(device, LIB, body, output="vec3", count=1, params=params)
    assert np.isfinite(got).all()


def test_a_cone_along_the_rim_of_a_light(device: Device) -> None:
    """Whatever share is met: its mean radiance is the light's, or nothing's."""
    rng = np.random.default_rng(2)
    direction = rng.normal(size=(500, 3)).astype(np.float32)
    direction[:, 1] = np.abs(direction[:, 1])
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    params = {"AreaLights": pack_area_lights([lamp(1.0, 1.0, radiance=3.0)])}
    body = "hit_area_lights(vec3(0.0), d, 0.01, 0.0, 0.1).radiance"
    got = run_glsl(device, LIB, body, {"d": direction}, "vec3", params=params)[:, 0]
    assert np.isfinite(got).all()
    met = got > 0.0
    assert 10 < met.sum() < 490
    np.testing.assert_allclose(got[met], 3.0, rtol=1e-3)


def test_what_is_no_number_becomes_one(device: Device) -> None:
    got = run_glsl(device, ["lib/finite.glsl"], "finite_radiance(vec3(x)).x", {"x": ODD})
    np.testing.assert_array_equal(got, [0, 65504, 0, 0, 0, 2, 65504, 65504])
    faults = run_glsl(device, ["lib/finite.glsl"], "is_fault(x)", {"x": ODD}, "bool")
    np.testing.assert_array_equal(faults, [1, 1, 1, 0, 0, 0, 0, 0])
