# GI-04
"""Closed surfaces have no holes: from outside, no path through faces leads in."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.gpu.device import Device
from elemental.gpu.gl import SHADER_STORAGE_BARRIER as STORAGE
from elemental.passes.voxel.grid import Grid
from elemental.passes.voxel.octree import Capacity, Survey
from elemental.passes.voxel.voxelize import voxelize
from gpu.rig import scene, vector
from gpu.voxel.flood import reached_from_outside
from gpu.voxel.scenes import part, turned
from gpu.voxel.stage import Lit
from shapes import Shape, box, sphere, torus

Array = npt.NDArray[Any]
TURN = turned(vector(0.31, 0.9, 0.2), 0.7)
SLAB = (2.0, 0.05, 1.6)


def voxels(device: Device, shape: Shape, resolution: int) -> tuple[Array, Grid]:
    """(X, Y, Z) bool: occupied lattice points of the turned shape, and the grid."""
    lit = Lit(device, scene(part(shape, 0, TURN)))
    grid = lit.grid(resolution)
    asked = lit.count(grid).fragments
    survey = Survey(device, grid, Capacity(asked, 1, 1, 1, 1), 0.0)
    g = device.begin_frame()
    fragments = voxelize(g, lit.gpu, survey)
    g.keep(fragments)
    g.execute()
    assert fragments.physical is not None
    code = fragments.physical.read(np.uint32, 4 * asked)[::4]
    occupied = np.zeros((resolution,) * 3, bool)
    occupied[code & 1023, code >> 10 & 1023, code >> 20 & 1023] = True
    for item in (survey, lit):
        item.release()
    return occupied, grid


def local_positions(grid: Grid, planes: Array) -> Array:
    """(3, len(planes), Y, Z) float32: the lattice points of some x planes, before the turn."""
    steps = (np.arange(grid.resolution) + grid.resolution / 2) * grid.voxel_m
    x, y, z = (grid.origin[k] + steps for k in range(3))
    inverse = np.linalg.inv(TURN.astype(np.float64))
    moved = np.empty((3, len(planes), len(y), len(z)), np.float32)
    for row, out in zip(inverse[:3], moved, strict=True):
        across = (row[0] * x[planes] + row[3])[:, None, None]
        out[:] = across + (row[1] * y)[:, None] + row[2] * z
    return moved


def in_sphere(p: Array) -> Array:
    return np.asarray((p**2).sum(axis=0) < 0.97**2)


def in_torus(p: Array) -> Array:
    return np.asarray((np.hypot(p[0], p[2]) - 1.0) ** 2 + p[1] ** 2 < 0.27**2)


def in_slab(p: Array) -> Array:
    return np.asarray((np.abs(p) < 0.499 * np.array(SLAB)[:, None, None, None]).all(axis=0))


BODIES: dict[str, tuple[Shape, Callable[[Array], Array]]] = {
    "sphere": (sphere(1.0, 24), in_sphere),
    "torus": (torus(1.0, 0.3, 24), in_torus),
    "slab": (box(SLAB), in_slab),
}


@pytest.mark.parametrize("resolution", [64, 128, 256])
@pytest.mark.parametrize("body", BODIES)
def test_a_closed_body_lets_nothing_in(device: Device, body: str, resolution: int) -> None:
    shape, is_inside = BODIES[body]
    occupied, grid = voxels(device, shape, resolution)
    inside = is_inside(local_positions(grid, np.arange(resolution)))
    assert inside.any()
    reached = reached_from_outside(occupied)
    assert not (reached & inside).any()
    assert reached.mean() > 0.2, "the outside is the outside"


def test_at_the_finest_resolution_each_step_through_a_face_meets_a_voxel(device: Device) -> None:
    """What a fill needs, looked at in some planes: of two neighbouring lattice points on either
    side of the slab's surface, one at least is occupied."""
    occupied, grid = voxels(device, box(SLAB), 512)
    planes = np.sort(np.random.default_rng(1).choice(511, 24, replace=False))
    pairs = np.stack([planes, planes + 1])
    p = np.abs(local_positions(grid, pairs.ravel()).reshape(3, 2, len(planes), 512, 512))
    beyond = (p - 0.5 * np.array(SLAB, np.float32)[:, None, None, None, None]).max(axis=0)
    inside = beyond < -1e-3 * grid.voxel_m
    outside = beyond > 1e-3 * grid.voxel_m
    held = occupied[pairs]
    steps = 0
    for axis in (0, 2, 3):
        (in_0, in_1), (out_0, out_1), (held_0, held_1) = (
            (a[:-1], a[1:]) for a in (np.moveaxis(v, axis, 0) for v in (inside, outside, held))
        )
        through = (in_0 & out_1) | (out_0 & in_1)
        assert (held_0 | held_1)[through].all()
        steps += int(through.sum())
    assert steps > 10_000


def test_the_three_views_wait_for_none_of_each_other(
    device: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each fragment takes a place of its own by an atomic: no storage barrier between the axes."""
    lit = Lit(device, scene(part(box((1.0, 1.0, 1.0)), 0, TURN)))
    survey = Survey(device, lit.grid(16), Capacity(10_000, 1, 1, 1, 1), 0.0)
    bits: list[tuple[str, int]] = []
    names: list[str] = []
    barrier, push = device.gl.glMemoryBarrier, device.executor._push

    def note(value: int) -> None:
        bits.append((names[-1], value))
        barrier(value)

    def name(of_pass: str) -> None:
        names.append(of_pass)
        push(of_pass)

    monkeypatch.setattr(device.executor, "_push", name)
    monkeypatch.setattr(device.gl, "glMemoryBarrier", note)
    g = device.begin_frame()
    g.keep(voxelize(g, lit.gpu, survey))
    g.execute()
    axes = [name for name in names if ".textures" in name]
    assert [name.split(".")[1] for name in axes] == ["x", "y", "z"]
    assert not [name for name, value in bits if name in axes[1:] and value & STORAGE]
    assert [name for name, value in bits if name == "voxelize.queue" and value & STORAGE]
    for item in (survey, lit):
        item.release()
