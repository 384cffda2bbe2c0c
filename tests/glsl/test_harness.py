"""The harness itself: every kind of input and output makes the trip."""

from __future__ import annotations

import numpy as np
import pytest

from elemental.gpu.device import Device
from elemental.gpu.shaders import ShaderError
from glsl.harness import run_glsl


def test_vectors_scalars_and_matrices_arrive(device: Device) -> None:
    rng = np.random.default_rng(1)
    m = rng.normal(size=(70, 3, 3))
    p = rng.normal(size=(70, 3))
    s = rng.integers(-5, 5, 70)
    got = run_glsl(device, [], "m * p * float(s)", {"m": m, "p": p, "s": s}, "vec3")
    want = np.einsum("nij,nj->ni", m, p) * s[:, None]
    np.testing.assert_allclose(got, want, rtol=1e-5, atol=1e-5)


def test_statements_and_booleans(device: Device) -> None:
    x = np.arange(5, dtype=np.uint32)
    got = run_glsl(device, [], "bool even = x % 2u == 0u; result = even;", {"x": x}, "bool")
    assert got.tolist() == [True, False, True, False, True]


def test_an_error_names_the_generated_line(device: Device) -> None:
    with pytest.raises(ShaderError, match=r"\.comp\.glsl:\d+: .*nothing"):
        run_glsl(device, [], "nothing(x)", {"x": np.zeros(1)})
