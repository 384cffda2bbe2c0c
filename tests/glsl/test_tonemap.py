"""The transfer curve and the dither."""

from __future__ import annotations

import numpy as np

from elemental.gpu.device import Device
from glsl.harness import run_glsl

TONEMAP = ["lib/tonemap.glsl"]


def test_the_transfer_curve_is_srgb(device: Device) -> None:
    x = np.linspace(0, 1, 1001)
    want = np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)
    got = run_glsl(device, TONEMAP, "srgb_encode(vec3(x)).g", {"x": x})
    np.testing.assert_allclose(got, want, atol=3e-5)


def test_dither_is_triangular_and_has_no_mean(device: Device) -> None:
    index = np.arange(320 * 180)
    body = "dither_triangular(uvec2(i % 320, i / 320))"
    noise = run_glsl(device, TONEMAP, body, {"i": index}, "vec3")
    assert np.abs(noise).max() <= 1.0
    np.testing.assert_allclose(noise.mean(axis=0), 0.0, atol=0.01)
    np.testing.assert_allclose(noise.var(axis=0), 1.0 / 6.0, rtol=0.02)
    assert np.abs(np.corrcoef(noise.T) - np.eye(3)).max() < 0.02
    np.testing.assert_array_equal(noise, run_glsl(device, TONEMAP, body, {"i": index}, "vec3"))
