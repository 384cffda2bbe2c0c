# GI-02 GI-05
"""Pools of moving scenes within a budget: when they are made anew, and how large."""

from __future__ import annotations

from dataclasses import replace

import pytest

from elemental.gpu.device import Device
from elemental.passes.voxel import sizing
from elemental.passes.voxel.lighting import VoxelLighting
from elemental.passes.voxel.octree import Capacity
from gpu.voxel.scenes import jumble
from gpu.voxel.stage import MakeStage, Stage
from gpu.voxel.test_moving_overflow import crowd
from gpu.voxel.test_pool_overflow import ASKED
from gpu.voxel.walk import show

ENOUGH = sizing.capacity_for(ASKED, 1 << 40, keeps_slots=True)


def test_a_crowd_over_its_budget_keeps_its_pools(
    device: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each frame asks for others, a few bricks more or fewer; a raised budget is taken at once."""
    lit, walk, voxels = crowd(device, 32)
    show(device, lit, voxels, walk.pose())
    voxels.budget_bytes = voxels.octree.capacity.nbytes(keeps_slots=True) // 2
    voxels.release()
    voxels._allocate(
        voxels.octree.grid, voxels._room_for(voxels.counts), voxels.octree.max_emission
    )
    voxels.invalidate("geometry")
    made: list[Capacity] = []
    allocate = VoxelLighting._allocate

    def noted(self: VoxelLighting, grid: object, capacity: Capacity, emission: float) -> None:
        made.append(capacity)
        allocate(self, grid, capacity, emission)  # type: ignore[arg-type]

    monkeypatch.setattr(VoxelLighting, "_allocate", noted)
    wanted = set()
    for _ in range(30):
        show(device, lit, voxels, walk.step())
        assert voxels.counts.bricks_dropped > 0
        wanted.add(voxels._room_for(voxels.counts))
    assert len(wanted) > 20
    assert len(made) <= 2
    assert voxels.octree.capacity.nbytes(keeps_slots=True) <= voxels.budget_bytes
    made.clear()
    voxels.budget_bytes = 1 << 28
    for _ in range(4):
        show(device, lit, voxels, walk.step())
    assert len(made) == 1
    assert not voxels.counts.overflowed
    for item in (voxels, lit):
        item.release()


@pytest.mark.parametrize("scarce", ["fragments", "tiles", "bricks", "leaves", "interior"])
def test_pools_that_would_hold_everything_are_worth_it_by_one(scarce: str) -> None:
    held = replace(ENOUGH, **{scarce: getattr(ENOUGH, scarce) - 1})
    if scarce in ("fragments", "tiles"):
        assert sizing.is_worth_it(ENOUGH, held, ASKED, True, True)
        return
    assert sizing.bricks_kept(held, ASKED, True, True) < ASKED.bricks
    assert sizing.bricks_kept(ENOUGH, ASKED, True, True) == ASKED.bricks
    assert sizing.is_worth_it(ENOUGH, held, ASKED, True, True)
    assert not sizing.is_worth_it(ENOUGH, ENOUGH, ASKED, True, True)
    assert not sizing.is_worth_it(held, ENOUGH, ASKED, True, True)


@pytest.mark.parametrize(("more", "worth"), [(2400, False), (2600, True)])
def test_pools_that_still_drop_must_hold_a_sixteenth_more(more: int, worth: bool) -> None:
    held = replace(ENOUGH, bricks=30_000, leaves=20_000)
    larger = replace(held, bricks=held.bricks + more, leaves=held.leaves + more)
    assert sizing.is_worth_it(larger, held, ASKED, True, True) is worth


@pytest.mark.parametrize("scarce", ["bricks", "leaves", "interior"])
def test_the_gpu_keeps_as_many_bricks_as_counted_on(
    stage: MakeStage, jumbled: Stage, scarce: str
) -> None:
    """Where bricks keep their slots, too: test_moving_overflow.py."""
    whole, full = jumbled.counts, jumbled.octree.capacity
    told = replace(full, **{scarce: getattr(full, scarce) * 2 // 3})
    kept = stage(jumble(), capacity=told, bounces=0).counts.bricks
    assert 0 < kept < whole.bricks
    assert sizing.bricks_kept(told, whole, one_leaf_level=True, slots=False) == kept


def test_slack_counts_what_was_dropped() -> None:
    """In a few words: what is asked for is what is held and what is not."""
    dropped = replace(
        ASKED, fragments=20_000, fragments_dropped=30_000, tiles=1, tiles_dropped=8_999,
        bricks=100, bricks_dropped=39_900, leaves=0, interior=100,
    )  # fmt: skip
    for slack in sizing.MOTION_SLACKS:
        got, want = (
            sizing.capacity_for(sizing.with_slack(counts, slack), 1 << 40)
            for counts in (dropped, ASKED)
        )
        assert got == want
        assert got.fragments == int(50_000 * slack) + 1


def test_no_pool_is_larger_than_a_storage_block() -> None:
    """Of attributes, 96 bytes a leaf, and of filtered values, 448 bytes a brick above the finest
    level, however much the budget allows."""
    many = replace(ASKED, bricks=9_000_000, leaves_asked=8_000_000, interior_asked=1_000_000,
                   fragments=20_000_000)  # fmt: skip
    got = sizing.capacity_for(many, 1 << 60)
    assert got.leaves == (1 << 27) // 96
    assert got.interior == (1 << 27) // 448
    assert got.fragments == (1 << 27) // 16
    assert got.bricks == got.leaves + got.interior
    some = replace(ASKED, bricks=1_590_000, leaves_asked=1_300_000, interior_asked=290_000)
    got = sizing.capacity_for(some, 1 << 60)
    assert (got.bricks, got.leaves, got.interior) == (1_590_000, 1_300_000, 290_000)


def test_a_budget_takes_slack_first_then_leaves_then_the_rest() -> None:
    """And is kept, but for fragments, tiles and the last brick."""
    roomy = sizing.capacity_in_motion(ASKED, 1 << 40)
    assert roomy.leaves == int(30_000 * sizing.MOTION_SLACKS[0]) + 1
    tight = sizing.capacity_in_motion(ASKED, roomy.nbytes(True) - 1)
    assert tight.leaves == int(30_000 * sizing.MOTION_SLACKS[1]) + 1
    assert tight.nbytes(True) > ENOUGH.nbytes(True)
    few = sizing.capacity_in_motion(ASKED, int(tight.nbytes(True) * 0.8))
    assert few.leaves < tight.leaves
    assert (few.interior, few.tiles, few.fragments) == (
        tight.interior,
        tight.tiles,
        tight.fragments,
    )
    least = sizing.capacity_in_motion(ASKED, tight.nbytes(True) // 4)
    assert least.leaves == 1
    assert least.interior < tight.interior
    assert least.nbytes(True) <= tight.nbytes(True) // 4
    assert (least.fragments, least.tiles) == (tight.fragments, tight.tiles)
