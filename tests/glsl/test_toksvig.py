"""The G-buffer blur's formulas against numpy. SH-08"""

from __future__ import annotations

import numpy as np

from elemental.gpu.device import Device
from glsl.harness import run_glsl


def test_the_power_is_reduced_as_on_the_slide(device: Device) -> None:
    """L = saturate(length * 1.002); SpecularPower *= L / (L + SpecularPower * (1 - L))"""
    power, length = np.meshgrid(np.geomspace(0.5, 262144, 40), np.linspace(0.02, 1.0, 50))
    inputs = {"power": power.ravel(), "len": length.ravel()}
    got = run_glsl(device, ["lib/gbuffer_blur.glsl"], "toksvig_power(power, len)", inputs)
    scale = np.clip(length.ravel() * 1.002, 0, 1)
    want = power.ravel() * scale / (scale + power.ravel() * (1 - scale))
    np.testing.assert_allclose(got, want, rtol=2e-3)
    flat = length.ravel() > 0.999
    np.testing.assert_array_equal(got[flat], inputs["power"][flat].astype(np.float32))


def test_neighbours_count_by_normal_and_depth(device: Device) -> None:
    turn = np.radians([0.0, 30.0, 60.0, 90.0, 180.0])
    n = np.tile([0.0, 0.0, 1.0], (5, 1))
    other = np.stack([np.sin(turn), np.zeros(5), np.cos(turn)], axis=1)
    got = run_glsl(device, ["lib/gbuffer_blur.glsl"], "blur_weight(n, other, 0.0)",
                   {"n": n, "other": other})  # fmt: skip
    np.testing.assert_allclose(got, [1.0, 0.75, 0.25, 0.0, 0.0], atol=1e-6)
    off = np.array([0.0, 2.0, 4.0, 100.0])
    body = "blur_weight(vec3(0, 0, 1), vec3(0, 0, 1), d)"
    got = run_glsl(device, ["lib/gbuffer_blur.glsl"], body, {"d": off})
    np.testing.assert_allclose(got, [1.0, 0.5, 0.0, 0.0], atol=1e-6)
