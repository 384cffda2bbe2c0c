"""Depths that translucent surfaces look up in the picture of what is behind them. SH-06"""

from __future__ import annotations

import numpy as np

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA16F
from elemental.gpu.refs import Sampled
from glsl.harness import run_glsl

SIZE = 8


def looked_up(device: Device, inverse: list[float], u: np.ndarray) -> np.ndarray:
    """Along a picture whose columns have these depths."""
    texels = np.zeros((SIZE, SIZE, 4), np.float16)
    texels[..., 3] = inverse
    picture = device.texture("behind", (SIZE, SIZE), RGBA16F, data=texels)
    uv = np.stack([u, np.full_like(u, 0.5)], axis=1)
    reads = {"u_behind": Sampled(picture, filter="trilinear")}
    view = np.zeros((), layouts().block("View"))
    found = run_glsl(
        device, ["lib/behind.glsl"], "inverse_depth_behind(uv)", {"uv": uv}, reads=reads,
        params={"View": view},
    )  # fmt: skip
    picture.release()
    return found


def test_at_a_silhouette_there_is_nothing_between_its_two_surfaces(device: Device) -> None:
    u = np.linspace(0.0, 1.0, 101)
    found = looked_up(device, [1.0] * 4 + [0.25] * 4, u)
    np.testing.assert_array_equal(found, np.where(u < 0.5, 1.0, 0.25))


def test_a_plane_has_no_steps(device: Device) -> None:
    """1 / distance is linear in the picture."""
    u = np.linspace(0.5 / SIZE, 1.0 - 0.5 / SIZE, 101)
    columns = 1.0 + np.arange(SIZE) / 64.0
    found = looked_up(device, list(columns), u)
    np.testing.assert_allclose(found, 1.0 + (u * SIZE - 0.5) / 64.0, atol=1e-4)
