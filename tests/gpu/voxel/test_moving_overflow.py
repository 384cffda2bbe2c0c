# GI-02 GI-05
"""Crowds in pools that are too small: nothing is written past their end, drops are counted, what is
left is a fresh build's, and larger pools make it whole."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.layout import layouts
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.gpu.resources import Buffer
from elemental.passes.voxel import sizing
from elemental.passes.voxel.lighting import VoxelLighting
from elemental.passes.voxel.octree import SIDED_BYTES_A_BRICK, Capacity
from elemental.scene.evaluate import Pose
from elemental.settings import Settings
from gpu.rig import camera, vector
from gpu.voxel.pools import read_leaves, read_sided
from gpu.voxel.stage import Lit, Stage
from gpu.voxel.test_moving_octree import fresh
from gpu.voxel.test_pool_overflow import CANARY
from gpu.voxel.walk import Walk, assert_same, held, show, world

Array = npt.NDArray[Any]
BODIES = 200


def crowd(device: Device, resolution: int) -> tuple[Lit, Walk, VoxelLighting]:
    lit = Lit(device, world(BODIES, seed=4))
    lit.scene.lights = lit.scene.lights[:1]
    walk = Walk(lit.scene, np.random.default_rng(2), 0.5)
    lit.gpu.update(walk.pose())
    return lit, walk, lit.lighting(resolution)


def tell(voxels: VoxelLighting, told: Capacity) -> dict[str, tuple[Buffer, int]]:
    """Tell the GPU of a smaller capacity than the pools have. What they hold past their told end,
    now canaries: by name, the buffer and the bytes told."""
    octree, kept = voxels.octree, voxels._kept
    assert kept is not None
    grid, size = octree.grid, {n: layouts().struct(n).itemsize for n in ("Node", "Brick")}
    octree.capacity = told
    block = octree._pack(*(octree_atlas(voxels)))
    octree.params = {"Octree": block}
    ends = {
        "nodes": (octree.nodes, (grid.dense_nodes + 8 * told.tiles) * size["Node"]),
        "bricks": (octree.bricks, told.bricks * size["Brick"]),
        "node blocks": (
            octree.node_blocks, grid.node_block_count * 16 + (told.bricks + told.tiles) * 4
        ),
        "lists": (octree.voxel_list, (octree._listed_voxels() + told.bricks) * 4),
        "attributes": (octree.attributes, told.leaves * 8 * 12),
        "radiance": (octree.radiance, told.leaves * 8 * 4),
        "fragments": (kept.fragments, told.fragments * 16),
        "links": (kept.links, told.fragments * 4),
        "heads": (kept.heads, told.leaves * 8 * 8),
        "free slots": (kept.free_slots, sum(told.slots(one_leaf_level=True)) * 4),
        "sided": (kept.sided, told.interior * SIDED_BYTES_A_BRICK),
    }  # fmt: skip
    ends = {name: (buffer, end) for name, (buffer, end) in ends.items() if end < buffer.nbytes}
    for buffer, end in ends.values():
        canaries = np.full((buffer.nbytes - end) // 4, CANARY, np.uint32)
        buffer.write(canaries.tobytes(), end)
    return ends


def octree_atlas(voxels: VoxelLighting) -> tuple[Any, Any]:
    """The places of bricks in the atlases, which stay as they were made."""
    block = voxels.octree.params["Octree"]
    return tuple(
        SimpleNamespace(side_log2=block[f"{name}_side_log2"], texel=block[f"{name}_texel"])
        for name in ("atlas", "leaf_atlas")
    )  # type: ignore[return-value]


def assert_nothing_beyond(
    device: Device,
    voxels: VoxelLighting,
    ends: dict[str, tuple[Buffer, int]],
    full: Capacity,
    told: Capacity,
) -> None:
    """Past what the GPU was told of, buffers hold their canaries and atlases nothing."""
    for name, (buffer, end) in ends.items():
        assert (buffer.read(np.uint32, offset=end) == CANARY).all(), name
    stage = cast(Stage, SimpleNamespace(device=device, octree=voxels.octree, counts=SimpleNamespace(
        interior=full.interior, bricks=full.bricks)))  # fmt: skip
    coarse, _, finest, _ = told.slots(one_leaf_level=True)
    assert not read_sided(stage)[coarse:].any()
    assert not read_leaves(stage)[finest:].any()


SHARES: dict[str, dict[str, float]] = {
    "fragments": {"fragments": 0.6},
    "tiles": {"tiles": 0.6},
    "leaves": {"bricks": 0.7, "leaves": 0.6},
    "interior": {"interior": 0.7},
    "a little": {"bricks": 0.76, "leaves": 0.74, "tiles": 0.75},
}


@pytest.mark.parametrize("case", SHARES)
def test_nothing_is_written_past_full_pools_while_things_move(
    device: Device, monkeypatch: pytest.MonkeyPatch, case: str
) -> None:
    lit, walk, voxels = crowd(device, 32)
    full = voxels.octree.capacity
    told = replace(full, **{k: int(getattr(full, k) * v) for k, v in SHARES[case].items()})
    ends = tell(voxels, told)
    grow = voxels._room_for
    monkeypatch.setattr(voxels, "_room_for", lambda counts: told)  # no room to grow to
    dropped = []
    for _ in range(25):
        show(device, lit, voxels, walk.step())
        dropped.append(voxels.counts.overflowed)
        assert voxels.counts.bricks <= told.bricks
        assert voxels.counts.tiles <= told.tiles
        assert voxels.counts.fragments <= told.fragments
        if voxels.counts.tiles_dropped == 0:
            kept = sizing.bricks_kept(told, voxels.counts, one_leaf_level=True, slots=True)
            assert voxels.counts.bricks == kept
    assert any(dropped)
    assert_nothing_beyond(device, voxels, ends, full, told)
    other = VoxelLighting(device, lit.gpu, voxels.octree.grid, 1.0, 3.0, 1, capacity=told)
    show(device, lit, other, walk.pose())
    assert voxels.counts == other.counts
    if not voxels.counts.fragments_dropped:  # which ones is left to chance
        assert_same(held(voxels.octree), held(other.octree))
    other.release()

    monkeypatch.setattr(voxels, "_room_for", grow)  # the budget is raised
    voxels.invalidate("geometry")
    for _ in range(4):
        show(device, lit, voxels, walk.pose())
    assert not voxels.counts.overflowed
    whole = fresh(lit, voxels)
    assert_same(held(voxels.octree), held(whole.octree))
    for item in (voxels, whole, lit):
        item.release()


def test_a_crowd_that_comes_and_goes(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    """Slots stay right through frames that overflow and frames that do not."""
    lit, walk, voxels = crowd(device, 32)
    walk.visible[:], few = True, np.arange(BODIES) % 20 == 0
    show(device, lit, voxels, replace(walk.pose(), visible=few))
    needed = voxels.counts
    interior, leaves = needed.interior + 30, needed.leaves + 60
    told = replace(
        voxels.octree.capacity, bricks=interior + leaves, interior=interior, leaves=leaves
    )
    voxels.release()
    voxels._allocate(voxels.octree.grid, told, voxels.octree.max_emission)
    voxels.invalidate("geometry")
    monkeypatch.setattr(voxels, "_room_for", lambda counts: told)
    dropped = []
    for frame in range(9):
        walk.world[0][0, 3] += 0.02
        everyone = frame % 3 == 1
        pose = walk.pose() if everyone else replace(walk.pose(), visible=few)
        show(device, lit, voxels, pose)
        dropped.append(voxels.counts.overflowed)
        other = fresh(lit, voxels)
        assert_same(held(voxels.octree), held(other.octree))
        other.release()
    assert dropped == [False, True, False] * 3
    for item in (voxels, lit):
        item.release()


def test_a_crowd_in_too_small_a_budget_is_still_a_picture(device: Device) -> None:
    """Of coarser leaves; a raised `gi.memory_budget_mb` brings all of them, as in a fresh build."""
    scene = world(BODIES, seed=4)
    scene.lights = scene.lights[:1]
    small = Settings().replace({"gi.resolution": 128, "gi.memory_budget_mb": 16})
    renderer = Renderer(device, scene, small, (48, 32))
    eye = camera(vector(0, 0.4, 2.4), vector(0, -0.2, 0))
    walk = Walk(scene, np.random.default_rng(3), 0.5)

    def voxels_after(made: Renderer, pose: Pose) -> VoxelLighting:
        frame = made.render(eye, 0.0, 0, "scene_color", pose)
        picture = made.read(frame)
        device.finish()
        assert np.isfinite(picture).all()
        assert 0.0 <= picture.min() <= picture.max() < 100.0
        assert picture[..., :3].mean() > 0.05
        assert frame.voxels is not None
        return frame.voxels

    for _ in range(2):
        voxels = voxels_after(renderer, walk.step())
        assert voxels.counters()["octree_levels_dropped"] == 1
        assert voxels.octree.capacity.nbytes(keeps_slots=True) <= 16 << 20
    renderer.set_settings(small.replace({"gi.memory_budget_mb": 256}))
    for _ in range(2):
        voxels = voxels_after(renderer, walk.step())
    assert not voxels.counts.overflowed
    assert voxels.counters()["octree_levels_dropped"] == 0
    assert voxels.octree.capacity.nbytes(keeps_slots=True) > 16 << 20
    other = Renderer(device, scene, Settings().replace({"gi.resolution": 128}), (48, 32))
    assert_same(held(voxels.octree), held(voxels_after(other, walk.pose()).octree))
    renderer.release()
    other.release()
