"""The tone curve, the transfer curve and the dither."""

from __future__ import annotations

import numpy as np

from elemental.gpu.device import Device
from glsl.harness import run_glsl

TONEMAP = ["lib/tonemap.glsl"]


def test_the_filmic_curve_rises_from_black_to_white(device: Device) -> None:
    x = np.concatenate([[0.0], np.exp2(np.linspace(-14, 12, 2000))])
    y = run_glsl(device, TONEMAP, "filmic_curve(vec3(x)).r", {"x": x})
    assert y[0] == 0.0
    assert np.all(np.diff(y) >= 0.0)
    assert y[-1] == 1.0
    fit = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)
    np.testing.assert_allclose(y, np.minimum(fit, 1.0), rtol=1e-4)


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
