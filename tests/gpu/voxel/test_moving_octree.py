# GI-02 GI-06
"""An octree that follows moving things is, after every frame, what a fresh build would be."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from elemental.gpu.device import Device
from elemental.passes.voxel.lighting import VoxelLighting
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
            other = fresh(lit, voxels)
            assert voxels.counts == other.counts
            assert not voxels.counts.overflowed
            assert_same(held(voxels.octree), held(other.octree))
            other.release()
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
