# GI-03
"""The pools by node index, and the bricks' borders against their neighbours' own voxels.

A brick holds 3x3x3 texels: its own 2x2x2 and a border on the + sides. Above the finest level a
texel has a colour for each of six sides, on the finest one colour and one normal.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.voxel.grid import REGION_SIDE
from gpu.rig import vector
from gpu.voxel.digest import contents
from gpu.voxel.pools import (
    ABSENT,
    Pools,
    leaf_values,
    read_leaves,
    read_sided,
    sided_values,
    sides_met,
    united_sides,
)
from gpu.voxel.scenes import grid_with, jumble
from gpu.voxel.stage import MakeStage, Stage

Array = npt.NDArray[Any]

NEIGHBOURS = [np.array(o) for o in product((-1, 0, 1), repeat=3) if any(o)]
TEXELS = np.array(list(product(range(3), repeat=3)))
BITS = np.array([1, 2, 4])
ROUNDING = 0.5 + 2e-3
"""Of a code, with what float32 may lose on the way to it."""
COLORS = (np.arange(28) % 4 < 3) & (np.arange(28) < 24)
"""Which channels of a brick's texels the multiplier scales."""


def span(offset: int) -> tuple[slice, slice]:
    """Texels along an axis that a brick shares with its neighbour: its own, and the neighbour's."""
    shared = {1: (slice(2, 3), slice(0, 1)), -1: (slice(0, 1), slice(2, 3))}
    return shared.get(offset, (slice(0, 3), slice(0, 3)))


@pytest.mark.parametrize("offset", NEIGHBOURS, ids=lambda o: "".join("-0+"[k + 1] for k in o))
def test_neighbours_agree_to_the_bit(jumbled: Stage, offset: Array) -> None:
    """Over every face, edge and corner: equal codes of opacity and normal, and of colour too where
    both bricks have the same multiplier."""
    pools, finest = Pools.read(jumbled), jumbled.own_grid.leaf_level
    kinds = (
        (range(finest), read_sided(jumbled), 0, ~COLORS),
        ([finest], read_leaves(jumbled), jumbled.counts.interior, np.arange(7) >= 3),
    )
    (ax, bx), (ay, by), (az, bz) = (span(int(k)) for k in offset)
    for levels, texels, first, unscaled in kinds:
        compared = 0
        for level in levels:
            ours = np.flatnonzero(pools.level == level)
            theirs = pools.brick_at(pools.cell[ours] + offset, level)
            ours, theirs = ours[theirs != ABSENT], theirs[theirs != ABSENT]
            mine, other = texels[ours - first][:, az, ay, ax], texels[theirs - first][:, bz, by, bx]
            np.testing.assert_array_equal(mine[..., unscaled], other[..., unscaled])
            same = pools.scale[ours] == pools.scale[theirs]
            np.testing.assert_array_equal(mine[same], other[same])
            compared += int((mine[same] > 0).any(axis=(1, 2, 3, 4)).sum())
        assert compared > 100


def lenders(stage: Stage, pools: Pools, texel: Array) -> tuple[Array, Array]:
    """(brick, voxel) that each brick takes the texel from, ABSENT where nobody has it.

    The brick whose own voxel stands there, else a leaf of a coarser region.
    """
    lender = np.full(len(pools.cell), ABSENT)
    voxel = np.zeros(len(pools.cell), np.int64)
    for level in range(stage.own_grid.leaf_level + 1):
        ours = np.flatnonzero(pools.level == level)
        points = 2 * pools.cell[ours] + texel
        found = pools.brick_at(points >> 1, level)
        at = (points & 1) @ BITS
        for above in range(1, level + 1):
            coarser = pools.brick_at(points >> (1 + above), level - above)
            lends = (found == ABSENT) & (coarser != ABSENT) & pools.is_leaf[coarser]
            found = np.where(lends, coarser, found)
            at = np.where(lends, (points >> above & 1) @ BITS, at)
        lender[ours], voxel[ours] = found, at
    return lender, voxel


def assert_borders(stage: Stage) -> int:
    """Every texel says what its lender says; the number of those lent by coarser leaves."""
    pools, interior = Pools.read(stage), stage.counts.interior
    sided, leaves = read_sided(stage), read_leaves(stage)
    hdr = sided_values(stage, pools)
    radiance, normals = leaf_values(stage)
    first_leaf = stage.state["level_first"][stage.own_grid.coarsest_leaf]
    lent = 0
    for texel in TEXELS:
        x, y, z = texel
        lender, voxel = lenders(stage, pools, texel)
        absent = lender == ABSENT
        assert (sided[absent[:interior], z, y, x] == 0).all(), "an absent neighbour is empty"
        assert (leaves[absent[interior:], z, y, x] == 0).all(), "an absent neighbour is empty"

        ours = np.flatnonzero(~absent[:interior])
        wanted = hdr[lender[ours], voxel[ours]].reshape(-1, 28) * 255.0
        wanted[:, COLORS] /= pools.scale[ours, None]
        assert wanted.max() <= 255.0 + ROUNDING
        assert np.abs(sided[ours, z, y, x] - wanted).max() <= ROUNDING, texel

        ours = interior + np.flatnonzero(~absent[interior:])
        slot = lender[ours] - first_leaf
        value = radiance[slot, voxel[ours]]
        wanted = value * 255.0
        wanted[:, :3] /= pools.scale[ours, None]
        tilted = normals[slot, voxel[ours]] * value[:, 3:] * 127.0
        got = leaves[ours - interior, z, y, x]
        assert np.abs(got - np.concatenate([wanted, tilted], axis=1)).max() <= ROUNDING, texel

        found = np.flatnonzero(~absent)
        coarser = pools.level[lender[found]] < pools.level[found]
        assert not (coarser & (texel < 2).all()).any()
        held = [leaves[b - interior, z, y, x, 3] if b >= interior else 0 for b in found[coarser]]
        lent += int((np.array(held) > 0).sum())
    return lent


def test_each_texel_is_its_owners_value(jumbled: Stage) -> None:
    """Own voxels and borders alike encode the owner's HDR value by the brick's own multiplier."""
    assert assert_borders(jumbled) == 0


def test_a_coarser_neighbour_lends_its_nearest_voxel(stage: MakeStage) -> None:
    offsets = np.random.default_rng(3).integers(-1, 2, (REGION_SIDE,) * 3)
    grid = grid_with(offsets, (vector(-1, -1, -1), vector(1, 1, 1)))
    assert assert_borders(stage(jumble(), grid=grid)) > 50


def test_lighting_anew_leaves_nothing_of_the_old_light(stage: MakeStage) -> None:
    """A second lighting gives what the first gave, to the bit."""
    made = stage(jumble())
    first = contents(made)
    made.light()
    assert contents(made) == first


def test_pools_are_addressed_by_the_node(jumbled: Stage) -> None:
    """Attributes and radiance of a leaf's voxels stand at its brick's place among the leaves."""
    pools, counts = Pools.read(jumbled), jumbled.counts
    leaves = np.flatnonzero(pools.level == jumbled.own_grid.leaf_level)
    assert counts.leaves == len(leaves)
    held = sides_met(jumbled)
    points = jumbled.fragment_points + jumbled.own_grid.resolution // 2
    brick = pools.brick_at(points >> 1, jumbled.own_grid.leaf_level)
    slot, voxel = brick - leaves[0], (points & 1) @ BITS
    wanted = united_sides(jumbled.fragments, slot * 8 + voxel, held.shape)
    np.testing.assert_array_equal(held, wanted)
    radiance, _ = leaf_values(jumbled)
    np.testing.assert_array_equal(radiance[..., 3] > 0, held > 0)
