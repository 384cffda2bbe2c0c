# GI-02 GI-06
"""An octree that follows moving things is, after every frame, what a fresh build would be."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.passes.voxel.lighting import SLICES, VoxelLighting
from gpu.rig import vector
from gpu.voxel.pools import rgb9e5_values
from gpu.voxel.scenes import colored, grid_with
from gpu.voxel.stage import Lit
from gpu.voxel.walk import Walk, assert_same, held, show, still, update, world


@pytest.fixture
def lit(device: Device) -> Iterator[Lit]:
    made = Lit(device, world(6))
    yield made
    made.release()


def fresh(lit: Lit, like: VoxelLighting, bounces: int = 1) -> VoxelLighting:
    """Another octree of the scene as it stands, built from nothing."""
    made = VoxelLighting(
        lit.device, lit.gpu, like.octree.grid, 1.0, like.octree.max_emission, 1 << 30,
        capacity=like.octree.capacity,
    )  # fmt: skip
    update(lit, made, bounces)
    lit.device.finish()
    return made


def assert_fresh(lit: Lit, voxels: VoxelLighting) -> None:
    """Nothing was dropped, and a fresh build counts and holds the same."""
    other = fresh(lit, voxels)
    assert voxels.counts == other.counts
    assert not voxels.counts.overflowed
    assert_same(held(voxels.octree), held(other.octree))
    other.release()


@pytest.mark.parametrize("resolution", [32, 64])
@pytest.mark.parametrize("share", [0.2, 1.0])
def test_a_walk_leaves_what_a_fresh_build_makes(
    device: Device, lit: Lit, resolution: int, share: float
) -> None:
    walk = Walk(lit.scene, np.random.default_rng(resolution), share)
    voxels = lit.lighting(resolution)
    for frame in range(12):
        show(device, lit, voxels, walk.step())
        if frame % 3 == 2:
            assert_fresh(lit, voxels)
    voxels.release()


def test_a_walk_leaves_what_a_still_scene_is_built_to(device: Device, lit: Lit) -> None:
    """The build without any steps, of a scene in which nothing can move."""
    walk = Walk(lit.scene, np.random.default_rng(3))
    voxels = lit.lighting(64)
    for _ in range(3):
        pose = walk.step()
        show(device, lit, voxels, pose)
    alone = Lit(device, still(lit.scene, pose))
    other = alone.lighting(64)
    assert not other.octree.keeps_slots
    update(alone, other)
    device.finish()
    for name in ("tiles", "bricks", "leaves", "interior"):
        assert getattr(voxels.counts, name) == getattr(other.counts, name)
    assert_same(held(voxels.octree), held(other.octree))
    for item in (voxels, other, alone):
        item.release()


def rasterized(names: list[str]) -> set[str]:
    """Which batches a frame voxelizes: "still", "moving", or "" for all."""
    views = [
        name.split(".") for name in names if name.startswith("voxelize.") and "textures" in name
    ]
    return {view[1] if view[1] in ("still", "moving") else "" for view in views}


def voxel_passes(names: list[str]) -> list[str]:
    return [n for n in names if n.startswith(("voxel", "reduce", "filter", "light voxels", "link"))]


def test_what_stands_is_rasterized_once(device: Device, lit: Lit) -> None:
    walk = Walk(lit.scene, np.random.default_rng(5), 0.2)
    voxels = lit.lighting(32)
    assert rasterized(show(device, lit, voxels, walk.pose())) == {"still", "moving"}
    for _ in range(3):
        walk.world[0][:3, 3] *= -1.0
        assert rasterized(show(device, lit, voxels, walk.pose())) == {"moving"}
    assert voxel_passes(show(device, lit, voxels, walk.pose())) == []
    voxels.release()


def listed(voxels: VoxelLighting) -> tuple[int, int]:
    """Leaf voxels and bricks that the last frame did anew."""
    state = voxels.octree.state.read(layouts().struct("OctreeState"), 1)[0]
    bricks = state["leaf_bricks"]["threads"] + state["interior_bricks"]["threads"]
    return int(state["leaf_voxels"]["threads"]), int(bricks)


def test_only_what_is_touched_is_done_anew(device: Device, lit: Lit) -> None:
    """One body of several moves by a voxel, and nothing is lit that it could shade."""
    lit.scene.lights.clear()
    walk = Walk(lit.scene, np.random.default_rng(5))
    voxels = lit.lighting(64)
    show(device, lit, voxels, walk.pose())
    every_voxel, every_brick = listed(voxels)
    walk.visible[:] = True
    show(device, lit, voxels, walk.pose())
    walk.world[0][1, 3] += 0.03
    show(device, lit, voxels, walk.pose())
    few_voxels, few_bricks = listed(voxels)
    assert 0 < few_voxels < 0.35 * every_voxel
    assert 0 < few_bricks < 0.6 * every_brick
    voxels.release()


def test_a_change_of_light_builds_nothing(device: Device, lit: Lit) -> None:
    """And leaves what a fresh build under that light makes."""
    walk = Walk(lit.scene, np.random.default_rng(6))
    voxels = lit.lighting(64)
    for _ in range(2):
        pose = walk.step()
        show(device, lit, voxels, pose)
    lit.scene.lights[0] = replace(lit.scene.lights[0], direction=vector(0.6, -0.8, 0.0))
    names = voxel_passes(update(lit, voxels))
    assert rasterized(names) == set()
    assert not any(word in name for name in names for word in ("reduce", "resolve", "slots"))
    other = fresh(lit, voxels)
    assert_same(held(voxels.octree), held(other.octree))
    for item in (voxels, other):
        item.release()


@pytest.mark.parametrize("bounces", [2, 3])
def test_further_bounces_are_complete_in_every_frame(
    device: Device, lit: Lit, bounces: int
) -> None:
    """A step's bricks stand in other slots: gathered values differ by rounding."""
    walk = Walk(lit.scene, np.random.default_rng(7))
    voxels = lit.lighting(32)
    for _ in range(4):
        show(device, lit, voxels, walk.step(), bounces)
    other = fresh(lit, voxels, bounces)
    got, wanted = held(voxels.octree), held(other.octree)
    np.testing.assert_array_equal(got.cell, wanted.cell)
    np.testing.assert_array_equal(got.attributes, wanted.attributes)
    light, same = (rgb9e5_values(h.radiance) for h in (got, wanted))
    assert light.max() > 0.1
    np.testing.assert_allclose(light, same, rtol=0.01, atol=2e-3)
    for item in (voxels, other):
        item.release()


def test_spread_gathers_settle_at_the_light_of_many_bounces(device: Device, lit: Lit) -> None:
    """Each frame gathers once, for an eighth of what did not change; then nothing is left to do."""
    lit.scene.lights = lit.scene.lights[:1]
    walk = Walk(lit.scene, np.random.default_rng(7))
    voxels = lit.lighting(32)
    show(device, lit, voxels, walk.step(), 4, True)
    for _ in range(3):
        names = show(device, lit, voxels, walk.step(), 4, True)
        assert names.count("light voxels") == 1
    pose, frames, every = walk.pose(), 0, listed(voxels)[0]
    while voxel_passes(names):
        names = show(device, lit, voxels, pose, 4, True)
        assert rasterized(names) == set()
        frames += 1
        if frames == 1:
            every = len(np.flatnonzero(held(voxels.octree).radiance.any(axis=2)))
            assert 0 < listed(voxels)[0] < 0.5 * every
    assert frames == 4 * SLICES + 1
    other = fresh(lit, voxels, 6)
    got, wanted = held(voxels.octree), held(other.octree)
    np.testing.assert_array_equal(got.attributes, wanted.attributes)
    light, same = (rgb9e5_values(h.radiance) for h in (got, wanted))
    np.testing.assert_allclose(light, same, rtol=0.03, atol=4e-3)
    once = fresh(lit, voxels, 1)
    assert np.abs(rgb9e5_values(held(once.octree).radiance) - same).max() > 0.05
    for item in (voxels, other, once):
        item.release()


def test_regions_of_several_levels_follow_too(device: Device, lit: Lit) -> None:
    offsets = np.random.default_rng(4).integers(-1, 2, (8, 8, 8))
    assert lit.scene.extent is not None
    grid = grid_with(offsets, lit.scene.extent, 32)
    counts = lit.count(grid)
    voxels = VoxelLighting(device, lit.gpu, grid, 1.0, 3.0, 1 << 30)
    assert voxels.octree.capacity.bricks > counts.bricks
    walk = Walk(lit.scene, np.random.default_rng(8), 0.4)
    for frame in range(9):
        show(device, lit, voxels, walk.step())
        if frame % 3 == 2:
            assert_fresh(lit, voxels)
    voxels.release()


def test_regions_change_without_rasterizing(device: Device, lit: Lit) -> None:
    """What stands keeps its fragments; its leaves move to other levels, and back."""
    assert lit.scene.extent is not None
    rng = np.random.default_rng(12)
    walk = Walk(lit.scene, rng, 0.5)
    plain = grid_with(np.zeros((8, 8, 8), int), lit.scene.extent, 64)
    voxels = VoxelLighting(device, lit.gpu, plain, 1.0, 3.0, 1 << 30)
    show(device, lit, voxels, walk.step())
    one_level = voxels.counts
    for levels in (rng.integers(-1, 1, (8, 8, 8)), np.zeros((8, 8, 8), int)):
        levels[0, 0, 0] = 0
        assert voxels.set_grid(grid_with(levels, lit.scene.extent, 64))
        pose = walk.pose()
        assert "still" not in rasterized(show(device, lit, voxels, pose))
        assert not voxels.counts.overflowed
        for _ in range(2):
            other = fresh(lit, voxels)
            assert voxels.counts == other.counts
            assert_same(held(voxels.octree), held(other.octree))
            other.release()
            if levels.any():
                assert voxels.counts.bricks < one_level.bricks
                show(device, lit, voxels, walk.step())
    finer = grid_with(np.ones((8, 8, 8), int), lit.scene.extent, 64)
    assert not voxels.set_grid(finer)  # on another lattice
    voxels.release()


def test_materials_of_what_moves_and_of_what_stands(device: Device, lit: Lit) -> None:
    walk = Walk(lit.scene, np.random.default_rng(9))
    voxels = lit.lighting(32)
    show(device, lit, voxels, walk.step())
    lit.gpu.set_material(2, replace(lit.scene.materials[2], emissive=vector(0.5, 1.0, 2.0)))
    # Only bodies that can move are of this one.
    assert all(lit.scene.instances[n].dynamic for n in range(len(lit.scene.instances))
               if lit.scene.meshes[lit.scene.instances[n].mesh].material == 2)  # fmt: skip
    assert rasterized(show(device, lit, voxels, walk.pose())) == {"moving"}
    before = fresh(lit, voxels)
    assert_same(held(voxels.octree), held(before.octree))
    before.release()
    lit.gpu.set_material(0, colored(0.1, 0.9, 0.3))
    assert "still" in rasterized(show(device, lit, voxels, walk.pose()))
    other = fresh(lit, voxels)
    assert_same(held(voxels.octree), held(other.octree))
    for item in (voxels, other):
        item.release()


def test_what_is_painted_again_and_again_counts_as_moving(device: Device) -> None:
    """In a scene in which nothing can move, too: from its third material on."""
    lit = Lit(device, world(0))
    voxels = lit.lighting(32)
    update(lit, voxels)
    seen = []
    for red in (0.2, 0.4, 0.6, 0.8):
        lit.gpu.set_material(1, colored(red, 0.3, 0.1))
        lit.gpu.update(None)
        seen.append(rasterized(update(lit, voxels)))
        device.finish()
        other = fresh(lit, voxels)
        assert_same(held(voxels.octree), held(other.octree))
        other.release()
    assert seen == [{""}, {"still", "moving"}, {"moving"}, {"moving"}]
    assert lit.gpu.dynamic.tolist() == [False, True, False]
    for item in (voxels, lit):
        item.release()


def test_frames_that_were_missed_are_made_up_for(device: Device, lit: Lit) -> None:
    """Poses that the octree did not see, while nobody looked at indirect light."""
    walk = Walk(lit.scene, np.random.default_rng(10))
    voxels = lit.lighting(32)
    show(device, lit, voxels, walk.step())
    for _ in range(3):
        lit.gpu.update(walk.step())
    show(device, lit, voxels, walk.step())
    other = fresh(lit, voxels)
    assert_same(held(voxels.octree), held(other.octree))
    for item in (voxels, other):
        item.release()


@pytest.mark.parametrize("resolution", [32, 64])
def test_a_thousand_frames_leak_nothing(device: Device, resolution: int) -> None:
    lit = Lit(device, world(4))
    walk = Walk(lit.scene, np.random.default_rng(11), 0.5)
    voxels = lit.lighting(resolution)
    octree, bytes_before, most = voxels.octree, device.bytes()["octree"], 0
    for _ in range(1000 if resolution == 32 else 250):
        lit.gpu.update(walk.step())
        update(lit, voxels)
        most = max(most, voxels.counts.bricks)
    device.finish()
    assert voxels.octree is octree  # no pool ever grew
    assert device.bytes()["octree"] == bytes_before
    state = octree.state.read(layouts().struct("OctreeState"), 1)[0]
    slots = octree.capacity.slots(one_leaf_level=True)
    used = state["slot_pools"]["used"]
    np.testing.assert_array_equal(used + state["slot_pools"]["free_count"], slots)
    other = fresh(lit, voxels)
    assert voxels.counts == other.counts
    assert 0 < voxels.counts.bricks <= most <= octree.capacity.bricks
    assert_same(held(octree), held(other.octree))
    for item in (voxels, other, lit):
        item.release()
