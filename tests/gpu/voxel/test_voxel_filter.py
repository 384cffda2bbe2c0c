# GI-08 GI-09
"""A voxel above the leaves is what its 27 finer ones say, column by column, side by side."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from gpu.voxel.pools import ABSENT, Pools, leaf_covers, leaf_values
from gpu.voxel.stage import Stage

Array = npt.NDArray[Any]
OCTANTS = np.arange(8)[:, None] >> np.arange(3) & 1
TENT = np.array([0.25, 0.5, 0.25])


def leaf_sides(stage: Stage) -> Array:
    """(S, 8, 7, 4) what the sides of leaf voxels show, and their opacities along the axes."""
    radiance, (sides, axes) = leaf_values(stage)[0], leaf_covers(stage)
    return with_opacity(radiance[:, :, None] * sides[..., None], radiance[..., 3:] * axes)


def with_opacity(sides: Array, opacity: Array) -> Array:
    """(N, 8, 7, 4) of sides (N, 8, 6, 4) and opacities along x, y and z (N, 8, 3)."""
    above = np.pad(opacity, [(0, 0)] * (opacity.ndim - 1) + [(0, 1)])
    return np.concatenate([sides, above[..., None, :]], axis=-2)


def over(front: Array, back: Array) -> Array:
    """What shows of both; the last channel hides."""
    return front + (1 - front[..., 4:]) * back


def half(slab: Array) -> Array:
    """Two of these in a row are as opaque as the slab."""
    opacity = 1 - np.sqrt(1 - slab[..., 4:])
    return np.asarray(slab * (opacity / np.maximum(slab[..., 4:], 1e-6)))


def filtered(around: Array) -> Array:
    """(N, 7, 4) from (N, 3, 3, 3, 7, 4) by [x, y, z, stack]."""
    sides = []
    for side in range(6):
        axis = side // 2
        slabs = np.concatenate([around[..., side, :], around[..., 6, axis, None]], axis=-1)
        along = np.moveaxis(slabs, 1 + axis, 1)
        low, middle, high = half(along[:, 0]), along[:, 1], half(along[:, 2])
        front, back = (low, high) if side % 2 else (high, low)
        columns = over(front, over(middle, back))
        sides.append(np.einsum("nijc,i,j->nc", columns, TENT, TENT))
    values = np.stack(sides, axis=1)
    return with_opacity(values[..., :4], values[:, ::2, 4])


@pytest.mark.parametrize("mip", [1, 2, 3])
def test_filtered_voxels_are_what_surrounds_them(jumbled: Stage, mip: int) -> None:
    pools, level = Pools.read(jumbled), jumbled.own_grid.leaf_level - mip
    finer, first = jumbled.sided, 0
    if mip == 1:
        finer, first = leaf_sides(jumbled), int(jumbled.state["level_first"][level + 1])
    bricks = np.flatnonzero(pools.level == level)
    bricks, octants = (part.ravel() for part in np.meshgrid(bricks, np.arange(8), indexing="ij"))
    held = pools.points[bricks] >> octants & 1 == 1
    bricks, octants = bricks[held], octants[held]
    points = 4 * pools.cell[bricks] + 2 * OCTANTS[octants]  # on the finer lattice
    around = np.zeros((len(points), 3, 3, 3, 7, 4))
    for place in np.ndindex(3, 3, 3):
        point = points + place - np.ones(3, int)
        brick = pools.brick_at(point >> 1, level + 1)
        octant = (point & 1) @ np.array([1, 2, 4])
        found = brick != ABSENT
        around[found, *place] = finer[brick[found] - first, octant[found]]
    wanted = filtered(around)
    assert len(wanted) > 50
    assert wanted[:, :6, 3].max() > 0.5
    got = jumbled.sided[bricks, octants]
    np.testing.assert_allclose(got, wanted, rtol=1.5 / 1024, atol=5e-5)
