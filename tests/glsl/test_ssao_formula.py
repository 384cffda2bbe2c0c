"""The slides' occlusion by angles against numpy. PP-03"""

from __future__ import annotations

import numpy as np

from elemental.gpu.device import Device
from glsl.harness import run_glsl

PIXELS = np.stack(np.meshgrid(np.arange(4), np.arange(4)), axis=-1).reshape(16, 2)


def offsets(device: Device) -> np.ndarray:
    """(16, 6, 2): the pattern's samples, as shares of the radius."""
    return np.stack(
        [
            run_glsl(
                device,
                ["lib/ssao.glsl"],
                "ssao_offset(pair, ssao_turn(pixel))",
                {"pixel": PIXELS, "pair": np.full(16, pair)},
                "vec2",
            )
            for pair in range(6)
        ],
        axis=1,
    )


def test_a_pair_s_angles_are_those_of_the_slide(device: Device) -> None:
    """(angle_left + angle_right) / 180, each at most 90 degrees off the normal."""
    rng = np.random.default_rng(3)
    left, right = rng.normal(size=(2, 400, 3))
    normal = rng.normal(size=(400, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    body = "0.5 * (open_angle(left, normal, 0.0, 1e6) + open_angle(right, normal, 0.0, 1e6))"
    inputs = {"left": left, "right": right, "normal": normal}
    got = run_glsl(device, ["lib/ssao.glsl"], body, inputs)

    def degrees(v: np.ndarray) -> np.ndarray:
        cosine = np.sum(v * normal, axis=1) / np.linalg.norm(v, axis=1)
        return np.minimum(np.degrees(np.arccos(cosine)), 90.0)

    want = np.minimum((degrees(left) + degrees(right)) / 180.0, 1.0)
    np.testing.assert_allclose(got, want, atol=2e-3)


def test_what_is_far_off_occludes_less_and_what_is_low_not_at_all(device: Device) -> None:
    up = np.tile([0.0, 1.0, 0.0], (4, 1))
    above = up * [[1.0], [1.5], [2.0], [2.5]]
    body = "open_angle(v, n, 0.0, 1.0)"
    got = run_glsl(device, ["lib/ssao.glsl"], body, {"v": above, "n": up})
    np.testing.assert_allclose(got, [0.0, 0.0, 0.5, 1.0], atol=1e-3)
    low = np.array([[1.0, 0.0299, 0.0], [1.0, 0.13, 0.0]])
    got = run_glsl(device, ["lib/ssao.glsl"], "open_angle(v, n, 0.03, 1.0)",
                   {"v": low, "n": up[:2]})  # fmt: skip
    assert got[0] == 1.0
    assert got[1] < 0.95


def test_the_pattern_holds_16_rotations_with_scale_of_6_pairs(device: Device) -> None:
    """192 samples, all apart: as many directions, and lengths spread evenly in the logarithm."""
    pairs = offsets(device).astype(np.float64)
    length = np.linalg.norm(pairs, axis=-1)
    angle = np.arctan2(pairs[..., 1], pairs[..., 0]) % np.pi
    gaps = np.diff(np.sort(angle.ravel()))
    np.testing.assert_allclose(gaps, np.pi / 96, rtol=0.01)
    for k in range(6):
        np.testing.assert_allclose(np.diff(np.sort(angle[:, k])), np.pi / 16, rtol=0.01)
    assert len(np.unique(length[:, 0].round(4))) == 16
    ratios = np.diff(np.sort(np.log(length.ravel())))
    np.testing.assert_allclose(ratios, -np.log(0.7) / 16, rtol=0.02)
    assert 0.11 < length.min() < length.max() < 1.0


def test_the_factor_is_the_open_share_to_a_power(device: Device) -> None:
    share = np.linspace(0.0, 1.0, 33)
    got = run_glsl(device, ["lib/ssao.glsl"], "ssao_factor(share, 2.0, 0.5)", {"share": share})
    np.testing.assert_allclose(got, 1.0 - 0.5 * (1.0 - share**2), atol=1e-6)
