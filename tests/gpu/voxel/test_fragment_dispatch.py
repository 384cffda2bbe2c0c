# GI-02 GI-05
"""The queue's indirect dispatch takes each fragment once; the GPU decides a frame alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.gpu.device import Device
from elemental.gpu.passes import ComputePass
from elemental.gpu.resources import Buffer, Texture
from elemental.passes.area_lights import pack_area_lights
from elemental.passes.voxel.grid import Grid
from gpu.rig import IDENTITY, mesh, scene, vector
from gpu.voxel.digest import contents
from gpu.voxel.pools import sides_met
from gpu.voxel.scenes import jumble
from gpu.voxel.stage import Lit, MakeStage, Stage

Array = npt.NDArray[Any]
PLUS_Z = 1 << 4
GRID = Grid.fit((vector(-1, -1, -1), vector(1, 1, 1)), 64)


def flakes(count: int) -> tuple[Array, Array]:
    """Squares parallel to the xy plane, each around one lattice point: seen along z alone."""
    half = 0.3 * GRID.voxel_m
    corners = np.array([[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]])
    place = np.stack([np.arange(count) % 40, np.arange(count) // 40, np.arange(count) % 7], axis=-1)
    centers = GRID.origin + (place + 44) * GRID.voxel_m
    positions = (centers[:, None] + corners).reshape(-1, 3).astype(np.float32)
    quads = 4 * np.arange(count)[:, None] + np.array([0, 1, 2, 0, 2, 3])
    if count == 0:  # a triangle between the lattice's lines
        positions = (GRID.origin + (44.3 + 0.1 * np.eye(3)) * GRID.voxel_m).astype(np.float32)
        quads = np.array([0, 1, 2])
    return positions, quads.ravel().astype(np.uint32)


@pytest.mark.parametrize("count", [0, 1, 127, 128, 129, 1000])
def test_each_fragment_is_consumed_once(stage: MakeStage, count: int) -> None:
    made = stage(scene((mesh(flakes(count)), IDENTITY)), grid=GRID, bounces=0)
    assert made.counts.fragments == len(made.fragments) == count
    assert made.state["fragments"]["x"] == -(-count // 128)
    met = sides_met(made)
    assert np.count_nonzero(met) == count
    assert np.isin(met, [0, PLUS_Z]).all()
    assert (made.counts.bricks > 0) == (count > 0)
    made.light()


def test_no_frame_waits_for_what_the_gpu_counted(
    device: Device, monkeypatch: pytest.MonkeyPatch, jumbled: Stage
) -> None:
    """The first frame is complete, though nothing has been read back; work whose size the GPU
    knows is dispatched from its own buffer."""
    lit = Lit(device, jumble())
    voxels = lit.lighting(64)

    def refuse(*_: object) -> None:
        raise AssertionError("a frame must not wait for the GPU")

    g = lit.begin()
    octree = voxels.update(g, lit.shadows, lit.sky, pack_area_lights([]), lit.light_key, bounces=1)
    named = {node.name.split(".")[0]: node for node in g.passes if isinstance(node, ComputePass)}
    for name in ("voxel/mark", "voxel/link", "voxel/resolve", "light voxels", "filter"):
        assert named[name].indirect is not None, name
    with monkeypatch.context() as patched:
        for kind in (Buffer, Texture):
            patched.setattr(kind, "read", refuse)
        g.execute()
    assert voxels.counts.bricks == 0, "nothing has been read back yet"
    probe = Stage.__new__(Stage)
    probe.device, probe.octree, probe.own_grid = device, octree, octree.grid
    assert contents(probe) == contents(jumbled)
    device.finish()
    assert voxels.counts == jumbled.counts
    voxels.release()
    lit.release()
