"""A bright room and a sealed one beside it, their walls of any thickness: what gets through.

Both are cubes hollowed out of one solid block; a lamp hangs in the middle of the first. The light
on the walls of the second comes through what should be opaque.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.gpu.device import Device
from elemental.passes.voxel.grid import Grid
from elemental.scene.model import Scene
from gpu.rig import at, scene, vector
from gpu.voxel.probe import gather
from gpu.voxel.scenes import TURNS, colored, glowing, part
from gpu.voxel.stage import Stage
from shapes import box, inward

Array = npt.NDArray[Any]

ROOM_M = 0.9
GRID = Grid.fit((vector(-1.5, -1.5, -1.5), vector(1.5, 1.5, 1.5)), 64)
PHASES = (0.0, 1.0 / 3.0, 2.0 / 3.0)
"""Where the walls stand between lattice points, in voxels along each axis."""
GATHERS = 3


def two_rooms(wall_m: float, world: Array) -> Scene:
    """The block with both rooms, placed by `world` (4, 4)."""
    reach = 0.5 * (ROOM_M + wall_m)
    room = inward(box((ROOM_M,) * 3))
    whole = (2.0 * ROOM_M + 3.0 * wall_m, ROOM_M + 2.0 * wall_m, ROOM_M + 2.0 * wall_m)
    return scene(
        part(box(whole), 0, world),
        part(room, 0, world @ at(-reach, 0, 0)),
        part(room, 0, world @ at(reach, 0, 0)),
        part(box((0.3, 0.3, 0.3)), 1, world @ at(-reach, 0, 0)),
        materials=[colored(0.8, 0.8, 0.8), glowing(10.0)],
    )


def leak(device: Device, wall_voxels: float, turn: str, phase: float = 0.0) -> tuple[float, float]:
    """Mean and largest light on the sealed room's walls, by the mean on the bright one's.

    Raises ValueError where the bright room is dark.
    """
    wall_m = wall_voxels * GRID.voxel_m
    world = np.asarray(at(*(phase * GRID.voxel_m,) * 3) @ TURNS[turn])
    made = Stage(device, two_rooms(wall_m, world), grid=GRID, bounces=GATHERS)
    rng, count = np.random.default_rng(8), 600
    axis, side = rng.integers(0, 3, count), rng.choice([-1, 1], count)
    p, normal = rng.uniform(-0.4, 0.4, (count, 3)), np.zeros((count, 3))
    p[np.arange(count), axis] = side * ROOM_M / 2
    normal[np.arange(count), axis] = -side
    light = []
    for x in (-0.5, 0.5):
        local = p + np.array([x * (ROOM_M + wall_m), 0.0, 0.0])
        rotation = world[:3, :3].astype(np.float64).T
        light.append(gather(made, local @ rotation + world[:3, 3], normal @ rotation)[:, 0])
    made.release()
    bright = float(light[0].mean())
    if bright <= 0.0:
        raise ValueError("the lamp's room is dark: there is nothing to leak")
    return float(light[1].mean()) / bright, float(light[1].max()) / bright
