# GI-08
"""RGBA8 under a power of two a brick, against the HDR values that it stands for."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from gpu.rig import at, scene
from gpu.voxel.pools import Pools, read_hdr, read_texels
from gpu.voxel.scenes import glowing, part
from gpu.voxel.stage import MakeStage, Stage
from shapes import sphere

Array = npt.NDArray[Any]


def assert_error(stage: Stage) -> Array:
    """Errors of at most 1/255 of the brick's maximum; the multipliers, (B,)."""
    pools, texels, hdr = Pools.read(stage), read_texels(stage), read_hdr(stage)
    decoded = texels.astype(np.float64) / 255.0
    decoded[..., :3] *= pools.scale[:, None, None, None, None, None]
    own = decoded[:, :, :2, :2, :2].reshape(len(hdr), 6, 8, 4).swapaxes(1, 2)
    error = np.abs(own - hdr)
    largest = np.maximum(
        hdr[..., :3].max(axis=(1, 2, 3)), decoded[..., :3].max(axis=(1, 2, 3, 4, 5))
    )
    lit = largest > 0
    relative = error[lit, ..., :3].max(axis=(1, 2, 3)) / largest[lit]
    print(f"radiance error, of the brick's maximum: {relative.max() * 255:.3f}/255")
    assert relative.max() <= 1 / 255
    assert error[..., 3].max() <= 0.5 / 255 + 1e-5
    assert (error[~lit, ..., :3] == 0).all()
    return np.asarray(pools.scale[lit])


def test_the_error_is_within_a_code_of_the_bricks_maximum(jumbled: Stage) -> None:
    scales = assert_error(jumbled)
    assert scales.max() / scales.min() > 1e4, "the scene spans several decades"


@pytest.mark.parametrize("brightest", [0, 15])
def test_dim_and_bright_bricks_keep_their_precision(stage: MakeStage, brightest: int) -> None:
    """Bodies each twice as bright as another, up to the end of what RGB9E5 says."""
    bodies, materials = [], []
    for k in range(12):
        radiance = 2.0 ** (brightest - k)
        bodies.append(part(sphere(0.12), k, at(k % 4 * 0.6 - 0.9, k // 4 * 0.6 - 0.6, 0)))
        materials.append(glowing(1.01 * radiance, 0.37 * radiance, 0.0))
    scales = assert_error(stage(scene(*bodies, materials=materials)))
    assert scales.max() == 2.0 ** (brightest + 1)
    assert scales.min() <= 2.0 ** (brightest - 10)
