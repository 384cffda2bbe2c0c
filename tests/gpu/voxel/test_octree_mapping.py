# GI-01
"""The octree's nodes against a dense octree in NumPy; the way from the world to them and back."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.voxel.grid import Grid
from glsl.harness import run_glsl
from gpu.rig import at, scene, vector
from gpu.voxel.numpy_octree import DenseOctree, leaf_level_of
from gpu.voxel.pools import ABSENT, Pools, cell_grid, morton
from gpu.voxel.scenes import jumble, part, turned
from gpu.voxel.stage import MakeStage, Stage
from shapes import box, sphere

Array = npt.NDArray[Any]


def locate(stage: Stage, points: Array, levels: Array) -> tuple[Array, Array, Array, Array]:
    """octree_locate: (N,) nodes, (N, 3) cells, (N, 3) local positions, (N,) levels reached."""

    def run(result: str, output: str) -> Array:
        return run_glsl(
            stage.device,
            ["lib/octree.glsl"],
            f"NodeLocation at = octree_locate(p, level); result = {result};",
            {"p": points.astype(np.float32), "level": levels},
            output,
            reads={"Nodes": stage.octree.nodes},
            params=stage.octree.params,
        )

    nodes, places = run("uvec4(at.node, at.cell)", "uvec4"), run("vec4(at.local, at.level)", "vec4")
    return nodes[:, 0], nodes[:, 1:].astype(np.int64), places[:, :3], places[:, 3].astype(int)


def position(stage: Stage, cells: Array, levels: Array, local: Array) -> Array:
    """octree_position."""
    return run_glsl(
        stage.device,
        ["lib/octree.glsl"],
        "octree_position(cell, level, local)",
        {"cell": cells.astype(np.uint32), "level": levels, "local": local},
        "vec3",
        reads={"Nodes": stage.octree.nodes},
        params=stage.octree.params,
    )


def assert_nodes(stage: Stage) -> Pools:
    """Nodes exist where the dense octree has them, at every level, and in Morton order.

    Bricks know which of their points hold anything, or may: beside coarser regions, which lend.
    """
    lends = stage.own_grid.coarsest_leaf < stage.own_grid.leaf_level
    dense = DenseOctree.of(stage.own_grid, stage.fragment_points)
    pools = Pools.read(stage)
    for level, exists in enumerate(dense.exists):
        np.testing.assert_array_equal(pools.brick[level] != ABSENT, exists, f"level {level}")
    assert stage.counts.bricks == sum(int(exists.sum()) for exists in dense.exists)
    order = np.stack([pools.level, morton(pools.cell)])
    assert (np.lexsort(order[::-1]) == np.arange(len(pools.cell))).all()
    for level, exists in enumerate(dense.exists):
        assert stage.state["level_first"][level] == np.searchsorted(pools.level, level)
        brick = pools.brick[level][exists]
        np.testing.assert_array_equal(pools.cell[brick], np.argwhere(exists))
        np.testing.assert_array_equal(pools.level[brick], level)
        np.testing.assert_array_equal(pools.node_of_brick[brick], pools.node[level][exists])
        for bit in range(8):
            x, y, z = (2 * np.argwhere(exists) + [bit & 1, bit >> 1 & 1, bit >> 2]).T
            held, wanted = (pools.points[brick] >> bit & 1) == 1, dense.occupied[level][x, y, z]
            if lends:
                assert held[wanted].all()
            else:
                np.testing.assert_array_equal(held, wanted)
    return pools


@pytest.mark.parametrize("resolution", [64, 128])
def test_a_node_exists_iff_it_touches_an_occupied_point(stage: MakeStage, resolution: int) -> None:
    made = stage(jumble(), resolution, bounces=0)
    pools = assert_nodes(made)
    dense_levels = range(made.own_grid.top_level + 1)
    assert len(dense_levels) < len(pools.brick), "some levels must be sparse"


def test_a_single_voxel_has_a_node_at_every_level(stage: MakeStage) -> None:
    """Also at the farthest corner that the scene's margin allows."""
    for corner in (-1.0, 1.0):
        dot = scene(part(sphere(0.03), 0, at(*[corner * 0.97] * 3)))
        grid = Grid.fit((vector(-1, -1, -1), vector(1, 1, 1)), 64)
        made = stage(dot, grid=grid, bounces=0)
        assert made.counts.fragments > 0
        assert_nodes(made)


def test_empty_nodes_name_their_largest_empty_ancestor(jumbled: Stage) -> None:
    """Which is what empty space is skipped by."""
    pools = Pools.read(jumbled)
    for level, node in enumerate(pools.node):
        cells = cell_grid(1 << level)[((node != ABSENT) & (pools.brick[level] == ABSENT)).ravel()]
        wanted = np.full(len(cells), level)
        for above in range(level - 1, -1, -1):
            x, y, z = (cells >> (level - above)).T
            wanted = np.where(pools.brick[above][x, y, z] == ABSENT, above, wanted)
        np.testing.assert_array_equal(pools.child_word[node[tuple(cells.T)]], wanted)


def true_leaves(stage: Stage, pools: Pools) -> Array:
    """(L,) bricks of the leaf level of their region."""
    leaf_levels = [
        leaf_level_of(stage.own_grid, cell[None], level)[0]
        for cell, level in zip(pools.cell, pools.level, strict=True)
    ]
    return np.flatnonzero(pools.level == np.array(leaf_levels))


def test_leaves_are_the_bricks_of_the_regions_leaf_level(jumbled: Stage) -> None:
    """An upper node without children is none: it is hollow, and empty on finer levels."""
    pools = Pools.read(jumbled)
    np.testing.assert_array_equal(np.flatnonzero(pools.is_leaf), true_leaves(jumbled, pools))


LOCALS = np.array([[0, 0, 0], [0.5, 0.5, 0.5], [0.875, 0, 0.125], [0.9375, 0.9375, 0.9375]])


def leaf_round_trip(stage: Stage) -> tuple[Array, Array]:
    """(got, wanted) local positions, once every leaf has been found again by its positions."""
    pools = Pools.read(stage)
    leaves = true_leaves(stage, pools)
    assert len(leaves) > 500
    cells = np.repeat(pools.cell[leaves], len(LOCALS), axis=0)
    levels = np.repeat(pools.level[leaves], len(LOCALS)).astype(np.int32)
    local = np.tile(LOCALS, (len(leaves), 1)).astype(np.float32)
    points = position(stage, cells, levels, local)
    for wanted in (levels, np.full_like(levels, stage.own_grid.leaf_level)):
        node, cell, got, reached = locate(stage, points, wanted)
        np.testing.assert_array_equal(reached, levels)
        np.testing.assert_array_equal(cell, cells)
        np.testing.assert_array_equal(node, np.repeat(pools.node_of_brick[leaves], len(LOCALS)))
    np.testing.assert_array_equal(position(stage, cell, reached, got), points)
    return got, local


def test_every_leaf_is_found_again_exactly(stage: MakeStage) -> None:
    """On a cube of dyadic size and place every float is exact, and so is the way there and back."""
    bounds = vector(-3.5, -3.5, -3.5), vector(3.625, 3.625, 3.625)  # 57 spacings of 1/8 m
    slab = part(box((6, 0.5, 5)), 0, turned(vector(1, 0.4, 0.2), 0.6))
    made = stage(
        scene(slab, part(sphere(0.8), 0, at(2, 2, 2))), grid=Grid.fit(bounds, 64), bounces=0
    )
    assert made.own_grid.voxel_m == 0.125
    got, wanted = leaf_round_trip(made)
    np.testing.assert_array_equal(got, wanted)


def test_every_leaf_is_found_again_on_any_cube(jumbled: Stage) -> None:
    """Elsewhere the node is exact and the local position within the rounding of its world point."""
    cells = np.array([[p] * 3 for p in (40, 64, 90)])
    points = jumbled.world(cells + 0.25)
    assert not np.array_equal(points.astype(np.float32).astype(np.float64), points)
    local = np.array([[0.5, 0.25, 0.75]], np.float32)
    pools = Pools.read(jumbled)
    leaves = true_leaves(jumbled, pools)
    levels = pools.level[leaves].astype(np.int32)
    p = position(jumbled, pools.cell[leaves], levels, np.repeat(local, len(leaves), axis=0))
    node, _, got, _ = locate(jumbled, p, levels)
    np.testing.assert_array_equal(node, pools.node_of_brick[leaves])
    np.testing.assert_allclose(got, np.repeat(local, len(leaves), axis=0), atol=2e-5)


def test_a_wanted_level_is_reached_or_the_deepest_above_it(jumbled: Stage) -> None:
    grid, pools = jumbled.own_grid, Pools.read(jumbled)
    rng = np.random.default_rng(1)
    points = rng.uniform(0.05, 0.95, (3000, 3)) * grid.size + grid.origin
    points = np.concatenate([points, jumbled.world(rng.integers(40, 88, (2000, 3)) + 0.25)])
    points = points.astype(np.float32)
    for level in range(grid.leaf_level + 1):
        node, cell, local, reached = locate(jumbled, points, np.full(len(points), level, np.int32))
        side = grid.size / (1 << level)
        in_cell = (points.astype(np.float64) - grid.origin) / side
        cells = np.floor(in_cell).astype(np.int64)
        deepest = np.zeros(len(points), int)
        for at_level in range(level + 1):
            x, y, z = (cells >> (level - at_level)).T
            deepest = np.where(pools.node[at_level][x, y, z] != ABSENT, at_level, deepest)
        np.testing.assert_array_equal(reached, deepest)
        np.testing.assert_array_equal(cell, cells >> (level - deepest)[:, None])
        wanted = [pools.node[k][tuple(c)] for k, c in zip(reached, cell, strict=True)]
        np.testing.assert_array_equal(node, wanted)
        exact = in_cell / (1 << (level - deepest))[:, None] - cell
        np.testing.assert_allclose(local, exact, atol=2e-5)
