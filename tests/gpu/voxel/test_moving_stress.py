# GI-02 GI-05
"""200 bodies at random for 2,000 frames in pools that are too small, then in larger ones."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.layout import layouts
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.passes.voxel.grid import Grid
from elemental.passes.voxel.lighting import VoxelLighting
from elemental.settings import Settings
from gpu.rig import camera, vector
from gpu.voxel.test_moving_overflow import BODIES, assert_nothing_beyond, tell
from gpu.voxel.walk import Walk, world

FRAMES = 2000
RECOVERY = 5
"""Frames until pools of a larger budget hold everything."""
LOOK_EVERY = 100
"""Frames between pictures: in the others the octree follows the bodies, and is not looked at."""
SIZE = (40, 30)
SHARES = {"fragments": 1.0, "tiles": 1.0, "bricks": 1.02, "leaves": 1.02, "interior": 1.04}
"""What the GPU is told that pools hold, by what the first frame asks for: now enough, now not."""
WHITE = 10.0
"""No surface can be brighter under this sun and these lamps."""


@pytest.mark.timeout(400)
def test_two_thousand_frames_in_pools_too_small(
    device: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = world(BODIES, seed=7)
    scene.lights = [replace(scene.lights[0], casts_shadow=False)]
    renderer = Renderer(device, scene, Settings(), SIZE)
    monkeypatch.setattr(renderer, "_grids", lambda: (Grid.fit(renderer._meshes.bounds, 32),))
    eye = camera(vector(0, 0.4, 2.4), vector(0, -0.2, 0))
    walk = Walk(scene, np.random.default_rng(8), 0.25)
    walk.visible = np.arange(BODIES) % 2 == 0  # as many as on average

    def show(number: int) -> npt.NDArray[Any] | None:
        looks = number % LOOK_EVERY == 0
        view = "scene_color" if looks else "pools"
        frame = renderer.render(eye, 0.0, number, view, walk.step())
        return renderer.read(frame)[..., :3] if looks else None

    show(0)
    device.finish()
    voxels = renderer._voxels
    assert voxels is not None
    counts, full = voxels.counts, voxels.octree.capacity
    asked = {
        "fragments": counts.fragments,
        "tiles": counts.tiles,
        "bricks": counts.bricks,
        "leaves": counts.leaves_asked,
        "interior": counts.interior_asked,
    }
    told = replace(full, **{name: int(asked[name] * share) for name, share in SHARES.items()})
    ends = tell(voxels, told)
    monkeypatch.setattr(voxels, "_room_for", lambda counts: told)  # the budget is spent
    voxels.invalidate("geometry")
    dropped = {"fragments": 0, "tiles": 0, "bricks": 0}
    for number in range(1, FRAMES):
        picture = show(number)
        for name in dropped:
            dropped[name] += getattr(voxels.counts, f"{name}_dropped") > 0
        if picture is not None:
            assert np.isfinite(picture).all()
            assert 0.0 <= picture.min() <= picture.max() < WHITE
            assert picture.mean() > 0.05
    device.finish()
    print(dropped)
    assert all(FRAMES // 20 < frames < FRAMES for frames in dropped.values()), dropped
    assert voxels.octree.capacity is told
    assert_nothing_beyond(device, voxels, ends, full, told)
    state = voxels.octree.state.read(layouts().struct("OctreeState"), 1)[0]
    used, free = state["slot_pools"]["used"], state["slot_pools"]["free_count"]
    np.testing.assert_array_equal(used + free, told.slots(one_leaf_level=True))

    monkeypatch.setattr(voxels, "_room_for", VoxelLighting._room_for.__get__(voxels))
    for number in range(FRAMES, FRAMES + RECOVERY):
        show(number)
    device.finish()
    assert not voxels.counts.overflowed
    renderer.release()
