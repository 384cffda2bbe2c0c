# GI-01 GI-05
"""Pools that can't be made large enough: the octree as a whole takes coarser leaves, instead of
leaving holes in walls, says so, and takes finer ones again once they fit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.passes.voxel import sizing
from elemental.passes.voxel.grid import Grid
from elemental.passes.voxel.octree import Capacity, Counts
from elemental.report import overflow_warnings
from elemental.scene.model import Region, Scene
from elemental.settings import Settings
from gpu.rig import camera, vector
from gpu.voxel.scenes import jumble
from gpu.voxel.walk import Walk, world

Array = npt.NDArray[Any]
EYE = camera(vector(0, 0.4, 2.4), vector(0, -0.2, 0))
MANY = 1 << 24


def renderer(device: Device, scene: Scene, resolution: int) -> Renderer:
    settings = Settings().replace({"gi.resolution": resolution, "gi.bounces": 2})
    return Renderer(device, scene, settings, (48, 32))


def picture(r: Renderer, frame: int = 0, pose: Any = None) -> tuple[Array, dict[str, int], Counts]:
    """Linear, and what its octree counted once it was drawn."""
    made = r.render(EYE, 0.0, frame, "scene_color", pose)
    image = r.read(made)
    r.device.finish()
    assert made.voxels is not None
    return image, made.voxels.counters(), made.voxels.counts


def limit_to(monkeypatch: pytest.MonkeyPatch, **most: int) -> None:
    """As if the driver's storage blocks held no more."""
    limits = replace(Capacity(MANY, MANY, MANY, MANY, MANY), **most)
    monkeypatch.setattr(sizing, "storage_max", lambda nbytes: limits)


@pytest.mark.parametrize("scarce", ["interior", "leaves", "fragments", "tiles"])
def test_the_first_picture_is_that_of_the_finest_octree_that_fits(
    device: Device, monkeypatch: pytest.MonkeyPatch, scarce: str
) -> None:
    coarse = renderer(device, jumble(), 64)
    wanted, counters, counts = picture(coarse)
    assert counters["octree_levels_dropped"] == 0
    coarse.release()
    limit_to(monkeypatch, **{scarce: getattr(counts, scarce) * 2})
    fine = renderer(device, jumble(), 256)
    got, counters, _ = picture(fine)
    assert counters["octree_levels_dropped"] == 2
    assert counters["octree_resolution"] == 64
    assert counters["octree_bricks_dropped"] == counters["voxel_fragments_dropped"] == 0
    np.testing.assert_array_equal(got, wanted)
    (line,) = overflow_warnings(counters)
    assert "gi.resolution" in line
    fine.release()


def test_a_finer_region_goes_first(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    """And what it held is as fine as the rest."""
    plain = renderer(device, jumble(), 64)
    wanted, _, counts = picture(plain)
    plain.release()
    limit_to(monkeypatch, interior=int(counts.interior * 1.1))
    scene = jumble()
    finer = [Region(vector(-1, -1, -1), vector(0, 1, 1), 2)]
    scene.regions = finer
    divided = renderer(device, scene, 64)
    got, counters, _ = picture(divided)
    assert (counters["octree_levels_dropped"], counters["octree_resolution"]) == (2, 64)
    np.testing.assert_array_equal(got, wanted)

    divided.set_regions([])  # nothing is lost any more
    got, counters, _ = picture(divided, 1)
    assert counters["octree_levels_dropped"] == 0
    np.testing.assert_array_equal(got, wanted)

    divided.set_regions(finer)
    assert picture(divided, 2)[1]["octree_levels_dropped"] == 2
    limit_to(monkeypatch)
    divided.set_regions([Region(vector(-1, -1, -1), vector(0, 1, 1), 1)])
    assert picture(divided, 3)[1]["octree_resolution"] == 128
    divided.release()


def test_a_crowd_that_outgrows_the_pools(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    """The frames after fall back; when most of it has left, the finer leaves come back."""
    scene = world(40, seed=4)
    scene.lights = scene.lights[:1]
    walk = Walk(scene, np.random.default_rng(2), 0.5)
    walk.visible[:] = True
    few = replace(walk.pose(), visible=np.zeros(40, bool))
    r = renderer(device, scene, 128)
    _, counters, counts = picture(r, 0, few)
    assert counters["octree_levels_dropped"] == 0
    limit_to(monkeypatch, interior=int(counts.interior * 1.4))
    assert picture(r, 1, walk.pose())[1]["octree_bricks_dropped"] > 0
    got, counters, _ = picture(r, 2, walk.pose())
    assert counters["octree_levels_dropped"] == 1
    assert counters["octree_bricks_dropped"] == 0
    coarse = renderer(device, scene, 64)
    np.testing.assert_allclose(got, picture(coarse, 2, walk.pose())[0], rtol=2e-3, atol=1e-4)
    coarse.release()
    for frame in range(3, 6):
        counters = picture(r, frame, few)[1]
    assert (counters["octree_levels_dropped"], counters["octree_resolution"]) == (0, 128)
    r.release()


def test_regions_chosen_while_things_move_outlive_a_fall(
    device: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = world(40, seed=4)
    walk = Walk(scene, np.random.default_rng(2), 0.5)
    walk.visible[:] = True
    few = replace(walk.pose(), visible=np.zeros(40, bool))
    r = renderer(device, scene, 128)
    picture(r, 0, few)
    made = r._voxels
    low, high = scene.bounds()
    r.set_regions([Region(low, (low + high) / 2, -1)])
    counts = picture(r, 1, few)[2]
    assert r._voxels is made, "kept fragments are marked anew"
    limit_to(monkeypatch, interior=int(counts.interior * 1.4))
    picture(r, 2, walk.pose())
    assert picture(r, 3, walk.pose())[1]["octree_levels_dropped"] > 0
    assert not made.octree.grid.one_leaf_level
    r.release()


def test_every_grid_of_a_ladder_is_one_level_coarser() -> None:
    bounds = vector(-1, -1, -1), vector(1, 1, 1)
    regions = [Region(vector(-1, -1, -1), vector(0, 1, 1), 2)]
    grids = Grid.ladder(bounds, 128, regions)
    assert [grid.leaf_level for grid in grids] == [9, 8, 7, 6, 5]
    assert [grid.coarsest_leaf for grid in grids] == [7, 7, 7, 6, 5]
    plain = Grid.fit(bounds, 64)
    assert grids[3].size == plain.size
    np.testing.assert_array_equal(grids[3].origin, plain.origin)


def test_pools_are_as_large_as_the_driver_allows() -> None:
    """And no larger than nodes, bricks and atlases can name."""
    small, large = sizing.storage_max(1 << 24), sizing.storage_max(1 << 31)
    assert small == Capacity((1 << 24) // 16, (1 << 24) // 64, (1 << 24) // 8, (1 << 24) // 96,
                             (1 << 24) // 448)  # fmt: skip
    assert large.interior == 97 << 14
    assert large.leaves == 682 << 14
    assert large.bricks < 1 << 24
    assert large.tiles * 8 + Grid.fit((vector(0, 0, 0), vector(1, 1, 1)), 512).dense_nodes < 1 << 24
    counts = Counts(9_000_000, 0, 500_000, 0, 3_000_000, 0, 0, 0, 2_400_000, 600_000)
    assert sizing.capacity_for(counts, 1 << 60, storage_bytes=1 << 31).interior == 600_000
    assert sizing.capacity_for(counts, 1 << 60).interior == (1 << 27) // 448
