# GI-03
"""The pools by node index, and the bricks' borders against their neighbours' own voxels."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.voxel.grid import REGION_SIDE
from gpu.rig import vector
from gpu.voxel.pools import ABSENT, Pools, read_hdr, read_texels
from gpu.voxel.scenes import grid_with, jumble
from gpu.voxel.stage import MakeStage, Stage

Array = npt.NDArray[Any]

NEIGHBOURS = [np.array(o) for o in product((-1, 0, 1), repeat=3) if any(o)]
TEXELS = np.array(list(product(range(3), repeat=3)))
ROUNDING = 0.5 + 2e-3
"""Of a code, with what float32 may lose on the way to it."""


def span(offset: int) -> tuple[slice, slice]:
    """Texels along an axis that a brick shares with its neighbour: its own, and the neighbour's."""
    shared = {1: (slice(2, 3), slice(0, 1)), -1: (slice(0, 1), slice(2, 3))}
    return shared.get(offset, (slice(0, 3), slice(0, 3)))


@pytest.mark.parametrize("offset", NEIGHBOURS, ids=lambda o: "".join("-0+"[k + 1] for k in o))
def test_neighbours_agree_to_the_bit(jumbled: Stage, offset: Array) -> None:
    """Over every face, edge and corner: equal codes of opacity, and of colour too where both bricks
    have the same multiplier."""
    pools, texels = Pools.read(jumbled), read_texels(jumbled)
    (ax, bx), (ay, by), (az, bz) = (span(int(k)) for k in offset)
    compared = 0
    for level in range(jumbled.own_grid.leaf_level + 1):
        ours = np.flatnonzero(pools.level == level)
        theirs = pools.brick_at(pools.cell[ours] + offset, level)
        ours, theirs = ours[theirs != ABSENT], theirs[theirs != ABSENT]
        mine, other = texels[ours][:, :, az, ay, ax], texels[theirs][:, :, bz, by, bx]
        np.testing.assert_array_equal(mine[..., 3], other[..., 3])
        same = pools.scale[ours] == pools.scale[theirs]
        np.testing.assert_array_equal(mine[same], other[same])
        compared += int(same.sum()) if level == jumbled.own_grid.leaf_level else 0
    assert compared > 100


def lenders(stage: Stage, pools: Pools, texel: Array) -> tuple[Array, Array]:
    """(brick, voxel) that each brick takes the texel from, ABSENT where nobody has it.

    The brick whose own voxel stands there, else a leaf of a coarser region.
    """
    lender = np.full(len(pools.cell), ABSENT)
    voxel = np.zeros(len(pools.cell), np.int64)
    bits = np.array([1, 2, 4])
    for level in range(stage.own_grid.leaf_level + 1):
        ours = np.flatnonzero(pools.level == level)
        points = 2 * pools.cell[ours] + texel
        found = pools.brick_at(points >> 1, level)
        at = (points & 1) @ bits
        for above in range(1, level + 1):
            coarser = pools.brick_at(points >> (1 + above), level - above)
            lends = (found == ABSENT) & (coarser != ABSENT) & pools.is_leaf[coarser]
            found = np.where(lends, coarser, found)
            at = np.where(lends, (points >> above & 1) @ bits, at)
        lender[ours], voxel[ours] = found, at
    return lender, voxel


def assert_borders(stage: Stage) -> int:
    """Every texel says what its lender says; the number of those lent by coarser leaves."""
    pools, texels, hdr = Pools.read(stage), read_texels(stage), read_hdr(stage)
    lent = 0
    for texel in TEXELS:
        x, y, z = texel
        codes = texels[:, :, z, y, x]
        lender, voxel = lenders(stage, pools, texel)
        assert (codes[lender == ABSENT] == 0).all(), "an absent neighbour is empty"
        ours = np.flatnonzero(lender != ABSENT)
        value = hdr[lender[ours], voxel[ours]].astype(np.float64)
        wanted = value * 255.0
        wanted[..., :3] /= pools.scale[ours, None, None]
        assert wanted.max() <= 255.0 + ROUNDING
        assert np.abs(codes[ours] - wanted).max() <= ROUNDING, texel
        coarser = pools.level[lender[ours]] < pools.level[ours]
        assert not (coarser & (texel < 2).all()).any()
        lent += int((coarser & (value[..., 3] > 0).any(axis=1)).sum())
    return lent


def test_each_texel_is_its_owners_value(jumbled: Stage) -> None:
    """Own voxels and borders alike encode the owner's HDR value by the brick's own multiplier."""
    assert assert_borders(jumbled) == 0


def test_a_coarser_neighbour_lends_its_nearest_voxel(stage: MakeStage) -> None:
    offsets = np.random.default_rng(3).integers(-1, 2, (REGION_SIDE,) * 3)
    grid = grid_with(offsets, (vector(-1, -1, -1), vector(1, 1, 1)))
    assert assert_borders(stage(jumble(), grid=grid)) > 50


def test_lighting_anew_leaves_nothing_of_the_old_light(stage: MakeStage) -> None:
    """The atlas after a second lighting is the first's to the bit."""
    made = stage(jumble())
    first = read_texels(made)
    made.light()
    np.testing.assert_array_equal(read_texels(made), first)


def test_pools_are_addressed_by_the_node(jumbled: Stage) -> None:
    """Attributes and radiance of a leaf's voxels stand at its brick's place among the leaves."""
    pools, counts = Pools.read(jumbled), jumbled.counts
    leaves = np.flatnonzero(pools.level == jumbled.own_grid.leaf_level)
    assert counts.leaves == len(leaves)
    held = jumbled.octree.attributes.read(np.uint32).reshape(-1, 8, 4)[: counts.leaves, :, 3]
    points = jumbled.fragment_points + jumbled.own_grid.resolution // 2
    brick = pools.brick_at(points >> 1, jumbled.own_grid.leaf_level)
    slot, voxel = brick - leaves[0], (points & 1) @ np.array([1, 2, 4])
    wanted = np.bincount(slot * 8 + voxel, minlength=held.size).reshape(held.shape)
    np.testing.assert_array_equal(held, wanted)
    radiance = jumbled.octree.radiance.read(np.float16).reshape(-1, 8, 4)[: counts.leaves]
    np.testing.assert_array_equal(radiance[..., 3] > 0, held > 0)
