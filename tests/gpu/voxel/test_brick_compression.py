# GI-08
"""RGBA8 under a power of two a brick, against the HDR values that it stands for."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from gpu.rig import at, scene
from gpu.voxel.pools import Pools, leaf_values, read_leaves, read_sided, sided_values
from gpu.voxel.scenes import glowing, part
from gpu.voxel.stage import MakeStage, Stage
from gpu.voxel.test_brick_borders import COLORS
from shapes import sphere

Array = npt.NDArray[Any]


def own_voxels(texels: Array) -> Array:
    """(B, 8, channels) of (B, 3, 3, 3, channels) texels, without the border."""
    return np.asarray(texels[:, :2, :2, :2].reshape(len(texels), 8, -1), np.float64)


def relative_errors(got: Array, wanted: Array, scale: Array, stored: Array) -> Array:
    """Largest error of a brick's colours over the largest value that it stores."""
    error = np.abs(got * (scale / 255.0)[:, None, None] - wanted).max(axis=(1, 2))
    largest = stored.reshape(len(stored), -1).max(axis=1) * scale / 255.0
    assert (error[largest == 0] == 0).all()
    return np.asarray(error / np.maximum(largest, 1e-30))


def assert_error(stage: Stage) -> Array:
    """Errors of at most 1/255 of the brick's maximum; the multipliers, (B,)."""
    pools, interior = Pools.read(stage), stage.counts.interior
    sided, leaves = read_sided(stage), read_leaves(stage)
    hdr, (radiance, normals) = sided_values(stage, pools), leaf_values(stage)
    wanted = hdr.reshape(interior, 8, 28)
    got = own_voxels(sided)
    above = relative_errors(
        got[..., COLORS], wanted[..., COLORS], pools.scale[:interior], sided[..., COLORS]
    )
    assert np.abs(got[..., ~COLORS] / 255.0 - wanted[..., ~COLORS]).max() <= 0.5 / 255 + 1e-5
    got = own_voxels(leaves)
    finest = relative_errors(
        got[..., :3], radiance[..., :3], pools.scale[interior:], leaves[..., :3]
    )
    assert np.abs(got[..., 3] / 255.0 - radiance[..., 3]).max() <= 0.5 / 255 + 1e-5
    assert np.abs(got[..., 4:] / 127.0 - normals * radiance[..., 3:]).max() <= 0.5 / 127 + 1e-5
    print(f"error, of a brick's maximum: {finest.max() * 255:.3f}/255 on the finest level, "
          f"{above.max() * 255:.3f}/255 above")  # fmt: skip
    assert max(finest.max(), above.max()) <= 1 / 255
    return pools.scale[np.append(sided.max(axis=(1, 2, 3, 4)), leaves.max(axis=(1, 2, 3, 4))) > 0]


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
