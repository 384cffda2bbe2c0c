"""Small encodings against numpy, over all their codes where there are few."""

from __future__ import annotations

import numpy as np

from elemental.gpu.device import Device
from glsl.harness import run_glsl

PACKING = ["lib/packing.glsl"]


def directions(count: int) -> np.ndarray:
    """(count, 3) unit vectors spread evenly, the axes and diagonals among them."""
    rng = np.random.default_rng(11)
    special = np.array([v for v in np.ndindex(3, 3, 3) if v != (1, 1, 1)], float) - 1.0
    vectors = np.concatenate([special, rng.normal(size=(count - len(special), 3))])
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def angles_deg(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    cross = np.linalg.norm(np.cross(a, b), axis=-1)
    return np.degrees(np.arctan2(cross, np.sum(a * b, axis=-1)))


def test_rgb9e5_keeps_colours_to_half_a_step_of_the_largest(device: Device) -> None:
    rng = np.random.default_rng(5)
    color = np.exp2(rng.uniform(-12, 15, (4096, 1))) * rng.uniform(0, 1, (4096, 3))
    color = color.astype(np.float32)
    back = run_glsl(device, PACKING, "rgb9e5_unpack(rgb9e5_pack(c))", {"c": color}, "vec3")
    # A largest channel that rounds up to a power of two takes the next exponent.
    step = np.exp2(np.floor(np.log2(color.max(axis=1) * (1 + 2.0**-9))) - 8)
    assert np.all(np.abs(back - color) <= 0.5 * step[:, None] * (1 + 1e-5))


def test_rgb9e5_codes_survive_and_extremes_clamp(device: Device) -> None:
    rng = np.random.default_rng(6)
    mantissa = rng.integers(0, 512, (2048, 3))
    mantissa[:, 0] = rng.integers(256, 512, 2048)  # normalized, as the encoder writes
    exponent = rng.integers(0, 32, 2048)
    codes = (mantissa[:, 0] | mantissa[:, 1] << 9 | mantissa[:, 2] << 18 | exponent << 27).astype(
        "u4"
    )
    back = run_glsl(device, PACKING, "rgb9e5_pack(rgb9e5_unpack(code))", {"code": codes}, "uint")
    np.testing.assert_array_equal(back, codes)
    extremes = np.array([[0, 0, 0], [1e9, 2, 3], [-1, 65408, 1]], np.float32)
    got = run_glsl(device, PACKING, "rgb9e5_unpack(rgb9e5_pack(c))", {"c": extremes}, "vec3")
    np.testing.assert_array_equal(got[0], 0.0)
    assert got[1, 0] == 65408.0
    np.testing.assert_array_equal(got[2], (0.0, 65408.0, 0.0))


def test_snorm8_normals_stay_within_half_a_degree(device: Device) -> None:
    n = directions(20000)
    body = "normal_snorm8_unpack(normal_snorm8_pack(n))"
    back = run_glsl(device, PACKING, body, {"n": n}, "vec3")
    assert angles_deg(back, n).max() < 0.35
    np.testing.assert_allclose(back[:26], n[:26], atol=1e-6)
    zero = run_glsl(device, PACKING, body, {"n": np.zeros((1, 3))}, "vec3")
    np.testing.assert_array_equal(zero, 0.0)


def test_ten_bit_normals_beat_the_plain_encoding(device: Device) -> None:
    """SH-01: A holds the world normal in RGB10; the claim of lib/packing.glsl."""
    n = directions(20000)
    quantized = "floor(normal10_encode(n) * 1023.0 + 0.5) / 1023.0"
    back = run_glsl(device, PACKING, f"normal10_decode({quantized})", {"n": n}, "vec3")
    plain = np.rint((n * 0.5 + 0.5) * 1023) / 1023 * 2 - 1
    assert angles_deg(back, n).max() < 0.08
    assert angles_deg(plain, n).max() > 0.09
    np.testing.assert_allclose(back[:26], n[:26], atol=1e-6)


def test_octahedral_map_round_trips_and_folds_onto_the_sphere(device: Device) -> None:
    n = directions(5000)
    back = run_glsl(device, PACKING, "octahedral_decode(octahedral_encode(n))", {"n": n}, "vec3")
    np.testing.assert_allclose(back, n, atol=2e-6)
    rng = np.random.default_rng(8)
    inside = rng.uniform(-0.99, 0.99, (500, 2))
    # Past an edge, the square goes on as its own image turned about the middle of that edge.
    over_x = np.stack([np.copysign(2.0, inside[:, 0]) - inside[:, 0], -inside[:, 1]], axis=1)
    over_y = np.stack([-inside[:, 0], np.copysign(2.0, inside[:, 1]) - inside[:, 1]], axis=1)
    for beyond in (over_x, over_y, inside):
        folded = run_glsl(device, PACKING, "octahedral_fold(p)", {"p": beyond}, "vec2")
        np.testing.assert_allclose(folded, inside, atol=1e-6)
    edge = rng.uniform(-1, 1, 200)
    both = [np.stack([np.ones(200), sign * edge], axis=1) for sign in (1, -1)]
    a, b = (run_glsl(device, PACKING, "octahedral_decode(p)", {"p": p}, "vec3") for p in both)
    np.testing.assert_allclose(a, b, atol=1e-6)


def test_octahedral_weight_is_the_solid_angle(device: Device) -> None:
    side = 512
    grid = (np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2) + 0.5) / side
    weight = run_glsl(device, PACKING, "octahedral_weight(p)", {"p": grid * 2 - 1})
    direction = run_glsl(device, PACKING, "octahedral_decode(p)", {"p": grid * 2 - 1}, "vec3")
    second_moment = np.einsum("n,ni,nj->ij", weight, direction, direction) / weight.sum()
    np.testing.assert_allclose(second_moment, np.eye(3) / 3, atol=1e-4)
