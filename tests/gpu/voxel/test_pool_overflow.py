# GI-05
"""Full queues and pools: nothing is written past their end, drops are counted, the pools grow.

The buffers here are larger than the GPU is told; what lies past the told end must stay as it was.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.refs import BufferHandle
from elemental.passes.area_lights import pack_area_lights
from elemental.passes.voxel import sizing
from elemental.passes.voxel.grid import REGION_SIDE
from elemental.passes.voxel.octree import Capacity, Counts, Octree
from gpu.voxel.numpy_octree import DenseOctree
from gpu.voxel.pools import ABSENT, Pools, read_leaves, read_sided, sides_met
from gpu.voxel.probe import gather, look_up, trace
from gpu.voxel.scenes import grid_with, jumble
from gpu.voxel.stage import BUDGET, Lit, MakeStage, Stage

Array = npt.NDArray[Any]

CANARY = 22 << 20 | 21 << 10 | 20
"""Read as a fragment, it says a place where the scene has nothing."""


class GuardedGraph(Graph):
    """A graph whose transient buffers begin full of canaries."""

    def buffer(self, name: str, nbytes: int) -> BufferHandle:
        handle = super().buffer(name, nbytes)
        self.clear_buffer(handle, CANARY)
        return handle


def guarded(device: Device) -> Graph:
    device.begin_frame()
    return GuardedGraph(device)


def tell(octree: Octree, told: Capacity) -> None:
    """Fill the pools with canaries and tell the GPU of a smaller capacity than they have."""
    pools = octree.nodes, octree.bricks, octree.voxel_list, octree.attributes, octree.radiance
    for pool in pools:
        pool.write(np.full(pool.nbytes // 4, CANARY, np.uint32))
    block = octree.params["Octree"].copy()
    for name in ("fragment", "tile", "brick", "leaf", "interior"):
        plural = {"leaf": "leaves", "interior": "interior"}.get(name, f"{name}s")
        block[f"{name}_capacity"] = getattr(told, plural)
    octree.params = {"Octree": block}


def overfilled(stage: MakeStage, full: Stage, told: Capacity) -> Stage:
    made: Stage = stage(
        jumble(),
        capacity=replace(full.octree.capacity, fragments=full.counts.fragments + 64),
        prepare=lambda octree: tell(octree, told),
        make_graph=guarded,
    )
    return made


def tails(stage: Stage, told: Capacity) -> dict[str, tuple[Array, int]]:
    """What lies past the end of each pool, as words, and what it has to be."""
    octree = stage.octree

    def words(name: str, nbytes: int) -> Array:
        return np.asarray(getattr(octree, name).read(np.uint32)[nbytes // 4 :])

    struct = {
        name: layouts().struct(name).itemsize for name in ("Node", "Brick", "VoxelAttributes")
    }
    lit = min(told.leaves * 8, told.fragments)
    leaves = read_leaves(stage)[max(told.bricks - told.interior, 0) :]
    return {
        "nodes": (
            words("nodes", (octree.grid.dense_nodes + 8 * told.tiles) * struct["Node"]),
            CANARY,
        ),
        "bricks": (words("bricks", told.bricks * struct["Brick"]), CANARY),
        "voxel list": (words("voxel_list", (told.interior * 8 + lit) * 4), CANARY),
        "attributes": (words("attributes", told.leaves * 8 * struct["VoxelAttributes"]), 0),
        "radiance": (words("radiance", told.leaves * 8 * 4), 0),
        "fragments": (stage.transients["voxel.fragments"][told.fragments * 4 :], CANARY),
        "sided": (stage.sided[told.interior :], 0),
        "sides": (read_sided(stage)[told.interior :], 0),
        "leaves": (leaves, 0),
    }


def assert_sane(stage: Stage, full: Stage) -> None:
    """The nodes lead to bricks that are theirs; whatever is asked has a finite answer."""
    pools, whole = Pools.read(stage), Pools.read(full)
    held = np.concatenate([brick[brick != ABSENT] for brick in pools.brick])
    assert len(np.unique(held)) == len(held)
    assert (held < stage.counts.bricks).all()
    for level, brick in enumerate(pools.brick):
        cells = np.argwhere(brick != ABSENT)
        mine = brick[tuple(cells.T)]
        np.testing.assert_array_equal(pools.cell[mine], cells)
        np.testing.assert_array_equal(pools.level[mine], level)
        assert (whole.brick[level][tuple(cells.T)] != ABSENT).all()
    rng = np.random.default_rng(2)
    points = full.world(rng.choice(full.fragment_points, 2000) + full.own_grid.resolution // 2)
    points += rng.uniform(-3, 3, points.shape) * full.own_grid.voxel_m
    directions = rng.normal(size=points.shape)
    brightest = max(m.emissive.max() for m in stage.scene.materials)
    for mip in range(8):
        value = look_up(stage, points, mip, directions)
        assert np.isfinite(value).all()
        assert 0.0 <= value[:, 3].min() <= value[:, 3].max() <= 1.0
        assert 0.0 <= value[:, :3].min() <= value[:, :3].max() <= 1.01 * brightest
    traced, gathered = trace(stage, points, directions, 0.3), gather(stage, points, directions)
    assert traced[:, 3].max() <= 1.001
    for value in (traced[:, :3], gathered):
        assert np.isfinite(value).all()
        assert 0.0 <= value.min() <= value.max() <= 1.01 * brightest


SHARES = {
    "fragments": {"fragments": 0.5},
    "one fragment": {"fragments": 0.0},
    "tiles": {"tiles": 0.5},
    "bricks": {"bricks": 0.6},
    "few bricks": {"bricks": 0.1},
    "leaves": {"leaves": 0.5},
    "interior": {"interior": 0.5},
    "everything": {"fragments": 0.9, "tiles": 0.7, "bricks": 0.6, "leaves": 0.3, "interior": 0.8},
}


@pytest.mark.parametrize("case", SHARES)
def test_nothing_is_written_past_a_full_pool(stage: MakeStage, jumbled: Stage, case: str) -> None:
    full = jumbled.octree.capacity
    told = replace(full, **{k: max(int(getattr(full, k) * v), 1) for k, v in SHARES[case].items()})
    made = overfilled(stage, jumbled, told)
    for name, (words, wanted) in tails(made, told).items():
        assert (words == wanted).all(), name
    counts, whole = made.counts, jumbled.counts
    assert counts.overflowed
    assert counts.fragments == min(told.fragments, whole.fragments)
    assert counts.fragments + counts.fragments_dropped == whole.fragments
    assert counts.tiles <= told.tiles
    assert counts.bricks <= told.bricks
    assert counts.leaves <= told.leaves
    if told.fragments >= whole.fragments:
        assert counts.tiles + counts.tiles_dropped == whole.tiles
        assert counts.bricks + counts.bricks_dropped == whole.bricks
    if told == replace(full, fragments=told.fragments):
        kept = DenseOctree.of(made.own_grid, made.fragment_points)
        assert counts.bricks == sum(int(exists.sum()) for exists in kept.exists)
    assert_sane(made, jumbled)


@pytest.mark.parametrize("scarce", ["bricks", "tiles"])
def test_fragments_of_dropped_leaves_go_nowhere(stage: MakeStage, scarce: str) -> None:
    """Not to the bricks above, whose attributes stay empty where regions have leaves of several
    levels."""
    offsets = np.random.default_rng(3).integers(-1, 2, (REGION_SIDE,) * 3)
    grid = grid_with(offsets, (np.full(3, -1.0), np.full(3, 1.0)))
    full = stage(jumble(), grid=grid, bounces=0)
    told = replace(full.octree.capacity, **{scarce: getattr(full.counts, scarce) * 3 // 4})
    made = stage(jumble(), grid=grid, capacity=told, bounces=0)
    assert made.counts.bricks_dropped > 0
    pools = Pools.read(made)
    first = int(made.state["level_first"][grid.coarsest_leaf])
    met = sides_met(made)
    assert not met[~pools.is_leaf[first:]].any()
    assert 0 < np.count_nonzero(met) < np.count_nonzero(sides_met(full))


@pytest.mark.parametrize("scarce", ["fragments", "tiles", "bricks", "leaves", "interior"])
def test_the_next_frames_grow_what_was_too_small(
    device: Device, jumbled: Stage, scarce: str
) -> None:
    """Each frame that hears of drops builds anew in larger pools, until nothing is dropped."""
    lit = Lit(device, jumble())
    full = jumbled.octree.capacity
    small = replace(full, **{scarce: max(getattr(full, scarce) // 3, 1)})
    voxels = lit.lighting(64, capacity=small)
    dropped = []
    for _ in range(4):
        g = lit.begin()
        voxels.update(g, lit.shadows, lit.sky, pack_area_lights([]), lit.light_key, bounces=1)
        g.execute()
        device.finish()
        dropped.append(voxels.counts.overflowed)
    assert dropped == [True, *dropped[1:3], False]
    counters = voxels.counters()
    assert not any(value for key, value in counters.items() if "dropped" in key)
    assert voxels.counts == jumbled.counts
    voxels.release()
    lit.release()


def test_drops_are_reported_by_what_dropped(device: Device, jumbled: Stage) -> None:
    lit = Lit(device, jumble())
    voxels = lit.lighting(64, capacity=replace(jumbled.octree.capacity, fragments=1000, bricks=400))
    g = lit.begin()
    voxels.update(g, lit.shadows, lit.sky, pack_area_lights([]), lit.light_key, bounces=1)
    g.execute()
    device.finish()
    counters = voxels.counters()
    assert counters["voxel_fragments"] == 1000
    assert counters["voxel_fragments_dropped"] == jumbled.counts.fragments - 1000
    assert counters["octree_bricks"] == 400
    assert counters["octree_bricks_dropped"] > 0
    voxels.release()
    lit.release()


def test_a_budget_too_small_is_kept_and_the_drops_stay_counted(device: Device) -> None:
    """Leaves are dropped, the coarse levels stay; no frame tries again in vain."""
    lit = Lit(device, jumble())
    whole = lit.lighting(64)
    budget = whole.octree.capacity.nbytes() * 2 // 3
    voxels = lit.lighting(64, budget=budget)
    assert voxels.octree.capacity.nbytes() <= budget
    names: list[list[str]] = []
    for _ in range(3):
        g = lit.begin()
        voxels.update(g, lit.shadows, lit.sky, pack_area_lights([]), lit.light_key, bounces=1)
        names.append([node.name for node in g.passes])
        g.execute()
        device.finish()
    assert any("voxelize" in name for name in names[0])
    assert not any("voxelize" in name or "light" in name for name in names[1] + names[2])
    assert voxels.counts.bricks_dropped > 0
    assert voxels.counts.fragments_dropped == voxels.counts.tiles_dropped == 0
    assert voxels.counts.interior == sizing.capacity_for(lit.count(lit.grid(64)), BUDGET).interior
    for item in (voxels, whole, lit):
        item.release()


ASKED = Counts(
    fragments=50_000,
    fragments_dropped=0,
    tiles=9_000,
    tiles_dropped=0,
    bricks=40_000,
    bricks_dropped=0,
    leaves=30_000,
    interior=10_000,
    leaves_asked=30_000,
    interior_asked=10_000,
)
"""Of a scene, as the GPU counts."""


def test_a_budget_cuts_no_more_than_it_must() -> None:
    wanted = sizing.capacity_for(ASKED, 1 << 40)
    assert (wanted.tiles, wanted.bricks, wanted.leaves) == (9_000, 40_000, 30_000)
    for budget in (wanted.nbytes() - 1, wanted.nbytes() // 2):
        cut = sizing.capacity_for(ASKED, budget)
        assert cut.nbytes() <= budget
        one_more = replace(cut, bricks=cut.bricks + 1, leaves=cut.leaves + 1)
        assert one_more.nbytes() > budget
        assert wanted.bricks - cut.bricks == wanted.leaves - cut.leaves
