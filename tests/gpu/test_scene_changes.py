"""What the device learns of a pose: rows, uploads and the list of changes. GI-06"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from elemental.gpu.resources import Buffer
from elemental.passes.scene_gpu import GpuScene
from elemental.scene.evaluate import evaluate
from gpu.moving import (
    Array,
    pose_of,
    stage,
)
from gpu.rig import at, mesh, scene
from shapes import box


def test_changes_tell_where_things_were_and_are(on_device: Any) -> None:
    world = stage()
    gpu = on_device(world)
    assert gpu.dynamic.tolist() == [False, False, True, True, True]
    gpu.update(evaluate(world, 0.0))
    assert (gpu.changes, gpu.version) == ([], 0)
    gpu.update(evaluate(world, 0.5))
    assert gpu.version == 1
    ball, sheet, cube = gpu.changes
    assert (ball.instance, sheet.instance, cube.instance) == (2, 3, 4)
    assert ball.moved
    for bounds, y in ((sheet.before, 2.5), (sheet.after, 2.0)):
        assert bounds is not None
        np.testing.assert_allclose(bounds, [[1.1, y, -0.4], [1.9, y, 0.4]], atol=1e-6)
    gpu.update(evaluate(world, 1.5))
    hidden = gpu.changes[2]
    assert hidden.before is not None
    assert hidden.after is None
    gpu.update(evaluate(world, 1.5))
    assert (gpu.changes, gpu.version) == ([], 2)
    gpu.update(evaluate(world, 2.0))
    shown = gpu.changes[2]
    assert (shown.before, shown.instance) == (None, 4)
    gpu.update(None)
    assert gpu.changes == []


def rows(gpu: GpuScene) -> Array:
    return gpu.instances.read(gpu._table.rows.dtype)


def test_rows_hold_this_frame_s_and_the_last_frame_s_transforms(on_device: Any) -> None:
    world = stage()
    gpu = on_device(world)
    before = rows(gpu)
    for t, t_before in ((0.25, 0.25), (0.5, 0.25), (0.5, 0.5), (1.5, 0.5)):
        gpu.update(evaluate(world, t))
        got, now, last = rows(gpu), evaluate(world, t), evaluate(world, t_before)
        np.testing.assert_array_equal(got[:2], before[:2])
        for number in (2, 3):
            k = number - 2
            matrix = got["world_from_local"][number].T
            np.testing.assert_array_equal(matrix, now.world_from_local[k])
            previous = got["prev_world_from_local"][number].T
            np.testing.assert_array_equal(previous, last.world_from_local[k])
    assert not rows(gpu)["world_from_local"][4].any()  # hidden
    gpu.update(evaluate(world, 2.0))
    np.testing.assert_array_equal(
        rows(gpu)["prev_world_from_local"][4], rows(gpu)["world_from_local"][4]
    )


def test_only_what_changed_is_uploaded(on_device: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    world = scene(*[(mesh(box()), at(3 * n, 0, 0)) for n in range(10)])
    for instance in world.instances[4:]:
        instance.dynamic = True
    gpu = on_device(world)
    numbers = np.arange(4, 10)
    worlds = np.array([at(3 * n, 0, 0) for n in numbers])
    written: list[tuple[str, int, int]] = []

    def note(buffer: Buffer, values: Any, offset: int = 0) -> None:
        written.append((buffer.name, len(values), offset // values.itemsize))

    monkeypatch.setattr(Buffer, "write", note)

    def update() -> list[tuple[str, int, int]]:
        written.clear()
        gpu.update(pose_of(instances=numbers, world_from_local=worlds, visible=np.ones(6, bool)))
        return written

    assert update() == []
    worlds = worlds.copy()
    worlds[[1, 3], 1, 3] = 1.0
    assert update() == [("scene.instances", 3, 5), ("scene.boxes", 3, 5)]
    assert [change.instance for change in gpu.changes] == [5, 7]
    assert update() == [("scene.instances", 3, 5)]  # they come to rest
    assert gpu.changes == []
    assert update() == []


def test_static_and_dynamic_instances_can_be_drawn_apart(on_device: Any) -> None:
    world = stage()
    gpu = on_device(world)
    modes = ("opaque", "mask", "blend")
    apart = {flag: gpu.batches(modes, dynamic=flag) for flag in (False, True)}
    for flag, batches in apart.items():
        drawn = [gpu._order[k] for batch in batches for k in gpu._culling.instances_of(batch)]
        assert sorted(drawn) == np.flatnonzero(gpu.dynamic == flag).tolist()
    assert gpu.batches(modes) == [*apart[False], *apart[True]]
