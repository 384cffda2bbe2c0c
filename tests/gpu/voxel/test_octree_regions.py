# GI-01
"""Regions with finer or coarser leaf levels than their neighbours.

Where levels meet, each node keeps to its own lattice: a brick's border takes the nearest point that
a coarser neighbour has, and a finer neighbour's value as filtered to the brick's own level. So the
value changes by at most what a voxel holds there, and nothing is lost.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.voxel.grid import REGION_SIDE, Grid
from elemental.scene.model import Region
from gpu.rig import at, scene, sun, vector
from gpu.voxel.numpy_octree import leaf_points
from gpu.voxel.pools import ABSENT, Pools, sides_met, united_sides
from gpu.voxel.probe import look_up
from gpu.voxel.scenes import grid_with, jumble, part, turned
from gpu.voxel.stage import MakeStage, Stage
from gpu.voxel.test_octree_mapping import assert_nodes, leaf_round_trip, locate, true_leaves
from shapes import box, sphere

Array = npt.NDArray[Any]


def checkered(seed: int, low: int = -1, high: int = 1) -> Array:
    """(8, 8, 8) offsets of leaf levels, at random."""
    return np.random.default_rng(seed).integers(low, high + 1, (REGION_SIDE,) * 3)


def halves(finer_from: int) -> Array:
    """(8, 8, 8) by [z, y, x]: one level finer from region ``finer_from`` along x."""
    offsets = np.zeros((REGION_SIDE,) * 3, np.int64)
    offsets[:, :, finer_from:] = 1
    return offsets


@pytest.fixture
def patchwork(stage: MakeStage) -> Stage:
    """Leaf levels 5 to 7 in a wild mixture."""
    bounds = vector(-1, -1, -1), vector(1, 1, 1)
    made = stage(jumble(), grid=grid_with(checkered(3), bounds))
    assert set(np.unique(made.own_grid.region_levels)) == {5, 6, 7}
    return made


def test_nodes_follow_each_regions_own_lattice(patchwork: Stage) -> None:
    assert_nodes(patchwork)


def test_the_level_reached_is_the_regions(patchwork: Stage) -> None:
    """At every occupied voxel; asking for a coarser level still gives that."""
    levels, points = leaf_points(patchwork.own_grid, patchwork.fragment_points)
    finest = patchwork.own_grid.leaf_level
    assert set(np.unique(levels)) == {5, 6, 7}
    p = patchwork.world(points * (1 << (finest - levels))[:, None] + 1e-3)
    _, cell, _, reached = locate(patchwork, p, np.full(len(p), finest, np.int32))
    np.testing.assert_array_equal(reached, levels)
    np.testing.assert_array_equal(cell, points >> 1)
    for wanted in range(6):
        reached = locate(patchwork, p, np.full(len(p), wanted, np.int32))[3]
        np.testing.assert_array_equal(reached, np.minimum(wanted, levels))


def test_every_leaf_of_a_patchwork_is_found_again(stage: MakeStage) -> None:
    bounds = vector(-3.5, -3.5, -3.5), vector(3.625, 3.625, 3.625)
    slab = part(box((6, 0.5, 5)), 0, turned(vector(1, 0.4, 0.2), 0.6))
    grid = grid_with(checkered(5), bounds)
    got, wanted = leaf_round_trip(stage(scene(slab), grid=grid, bounces=0))
    np.testing.assert_array_equal(got, wanted)


def test_leaves_of_a_patchwork_are_of_their_regions_level(patchwork: Stage) -> None:
    pools = Pools.read(patchwork)
    np.testing.assert_array_equal(np.flatnonzero(pools.is_leaf), true_leaves(patchwork, pools))


def test_every_fragment_lands_in_a_leaf(patchwork: Stage) -> None:
    """A leaf's sides are those of all its fragments, on each level."""
    met = sides_met(patchwork)
    levels, points = leaf_points(patchwork.own_grid, patchwork.fragment_points)
    pools = Pools.read(patchwork)
    first = patchwork.state["level_first"][patchwork.own_grid.coarsest_leaf]
    for level in np.unique(levels):
        here = points[levels == level]
        brick = pools.brick_at(here >> 1, level)
        assert (brick != ABSENT).all()
        slots = (brick - first) * 8 + (here & 1) @ [1, 2, 4]
        wanted = united_sides(patchwork.fragments[levels == level], slots, met.shape)
        np.testing.assert_array_equal(met[wanted > 0], wanted[wanted > 0])
        met[wanted > 0] = 0
    assert not met.any()


def test_a_uniform_surface_crosses_a_change_of_level_unbroken(stage: MakeStage) -> None:
    """A lit plate through regions of both levels: as opaque and as bright all along."""
    plate = part(box((1.9, 0.4, 1.9)), 0, at(0, 0, 0))
    bounds = vector(-1, -1, -1), vector(1, 1, 1)
    grid = grid_with(halves(4), bounds)
    made = stage(scene(plate, lights=[sun(vector(0, -1, 0))]), grid=grid)
    x = np.linspace(-0.7, 0.7, 400)
    top = np.rint(made.lattice([[0, 0.2, 0]])[0, 1] / 2) * 2  # on both lattices
    height = made.world([[0, top, 0]])[0, 1]
    p = np.stack([x, np.full_like(x, height), np.full_like(x, 0.11)], axis=-1)
    for mip in range(1, 3):
        value = look_up(made, p, mip, vector(0, -1, 0))
        assert value[:, 3].min() > 0.5 * value[:, 3].max(), mip
        shown = value[:, 0] / value[:, 3]
        assert shown.min() > 0.8 * shown.max(), mip


def test_a_finer_region_resolves_what_a_coarser_one_does_not(stage: MakeStage) -> None:
    """Two pairs of balls, a coarse voxel apart: only the pair in the finer regions is two."""
    bounds = vector(-1, -1, -1), vector(1, 1, 1)
    gap = Grid.fit(bounds, 64).voxel_m
    centers = [(x, y * (0.2 + gap / 2), 0.0) for x in (-0.5, 0.5) for y in (-1, 1)]
    balls = scene(*(part(sphere(0.2), 0, at(*center)) for center in centers))
    made = stage(balls, grid=grid_with(halves(4), bounds), bounces=0)
    levels, points = leaf_points(made.own_grid, made.fragment_points)
    for x, level in ((-0.5, 6), (0.5, 7)):
        between = made.lattice([[x, 0.0, 0.0]])[0] / (1 << (7 - level))
        here = points[levels == level]
        beside = (np.abs(here[:, [0, 2]] - between[[0, 2]]) < 0.1 / made.own_grid.voxel_m).all(
            axis=1
        )
        rows = np.unique(here[beside, 1])
        assert (np.diff(rows) > 1).any() == (x > 0)


def test_regions_of_the_scene_shift_the_leaf_levels_that_they_overlap() -> None:
    bounds = vector(-1, -1, -1), vector(1, 1, 1)
    upper = Region(vector(-1, 0.3, -1), vector(1, 1, 1), 1)
    corner = Region(vector(0.8, 0.8, -1), vector(1, 1, 1), -1)
    levels = Grid.fit(bounds, 64, [upper, corner]).region_levels
    assert set(np.unique(levels[:, :4])) == {6}
    assert set(np.unique(levels[:, 6:, :6])) == {7}
    assert set(np.unique(levels[:, 7, 7])) == {5}


def test_leaf_levels_stay_where_a_leaf_can_answer_for_finer_ones() -> None:
    """Not above the last dense level, and not past what a brick's cell can say."""
    bounds = vector(-1, -1, -1), vector(1, 1, 1)
    fine = Region(vector(0, 0, 0), vector(1, 1, 1), 9)
    coarse = Region(vector(-1, -1, -1), vector(-0.5, 1, 1), -9)
    grid = Grid.fit(bounds, 128, [fine, coarse])
    assert grid.leaf_level == 9
    assert grid.coarsest_leaf >= grid.top_level
