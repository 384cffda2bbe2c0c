# GI-09
"""Voxels look different from different sides: a thin wall, red in front and green behind.

Its two layers stand two voxels apart, so that they share none of the finest.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.voxel.grid import Grid
from gpu.rig import IDENTITY, at, scene, sun, vector
from gpu.voxel.probe import look_up, trace
from gpu.voxel.scenes import colored, glowing, part, turned
from gpu.voxel.stage import MakeStage, Stage
from shapes import box, quad

Array = npt.NDArray[Any]

GRID = Grid.fit((vector(-1.2, -1.2, -1.2), vector(1.2, 1.2, 1.2)), 64)
TURNS = {
    "along an axis": turned(vector(0, 0, 1), -np.pi / 2),
    "diagonal": turned(vector(0, 0, 1), 0.75 * np.pi),
    "slanted": turned(vector(0.2, 0.3, 1.0), -1.2),
}
WRONG = {"along an axis": (0.001, 0.001), "diagonal": (0.1, 0.001), "slanted": (0.06, 0.06)}
"""Most of the other side's light, as a share of this side's: on the finest level, where a lookup
between two layers mixes them, and above. A side that is seen edge-on serves the half space in front
of the wall and the one behind it."""
WRONG_IN_CONES = {"along an axis": 0.001, "diagonal": 0.03, "slanted": 0.03}


def wall(stage: MakeStage, turn: Array) -> Stage:
    """Red towards the turned +y axis, green towards -y."""
    half = GRID.voxel_m
    front, back = turn @ at(0, half, 0), turn @ at(0, -half, 0) @ turned(vector(1, 0, 0), np.pi)
    layers = (part(quad(1.8), k, placed) for k, placed in enumerate((front, back)))
    made: Stage = stage(scene(*layers, materials=[glowing(1, 0, 0), glowing(0, 1, 0)]), grid=GRID)
    return made


def beside(turn: Array, rng: np.random.Generator, depth: Array) -> Array:
    """World points ``depth`` m in front of the wall's middle, off its rim."""
    across = rng.uniform(-0.4, 0.4, (2, len(depth)))
    local = np.stack([across[0], depth, across[1]])
    return np.asarray((turn[:3, :3].astype(np.float64) @ local).T)


@pytest.mark.parametrize("name", TURNS)
def test_each_side_of_a_wall_shows_its_own_light_at_every_level(
    stage: MakeStage, name: str
) -> None:
    turn, rng = TURNS[name], np.random.default_rng(5)
    made, normal = wall(stage, turn), turn[:3, 1]
    for mip in range(7):
        depth = rng.uniform(-1.5, 1.5, 2000) * GRID.voxel_m * 2**mip
        points = beside(turn, rng, depth)
        for towards, right, wrong in ((-normal, 0, 1), (normal, 1, 0)):
            seen = look_up(made, points, mip, towards).sum(axis=0)
            share = seen[wrong] / seen[right]
            print(f"{name}, mip {mip}: {share:.4f} of the other side's light")
            assert seen[right] > 0.05 * seen[3]
            assert share <= WRONG[name][min(mip, 1)], mip


@pytest.mark.parametrize("half_angle", [0.02, 0.1, 0.33, 0.6])
@pytest.mark.parametrize("name", TURNS)
def test_cones_from_each_side_see_that_side(stage: MakeStage, name: str, half_angle: float) -> None:
    turn, rng = TURNS[name], np.random.default_rng(6)
    made, normal = wall(stage, turn), turn[:3, 1]
    for side, right, wrong in ((1, 0, 1), (-1, 1, 0)):
        points = beside(turn, rng, np.full(500, side * 0.5))
        seen = trace(made, points, -side * normal, half_angle).mean(axis=0)
        print(f"{name}, {half_angle}: {seen[right]:.3f} of its own, {seen[wrong]:.4f} of the other")
        assert seen[right] > 0.4
        assert seen[wrong] <= WRONG_IN_CONES[name] * seen[right]


def test_a_wall_lit_on_one_side_is_dark_on_the_other(stage: MakeStage) -> None:
    """Direct light, and the box's own thickness: two voxels."""
    slab = part(box((2 * GRID.voxel_m, 1.8, 1.8)), 0, IDENTITY)
    white = scene(slab, materials=[colored(1, 1, 1)], lights=[sun(vector(-1, 0, 0))])
    made = stage(white, grid=GRID)
    rng = np.random.default_rng(7)
    for mip in range(7):
        depth = rng.uniform(-1.5, 1.5, 1000) * GRID.voxel_m * 2**mip
        points = np.stack([depth, *rng.uniform(-0.4, 0.4, (2, 1000))], axis=-1)
        lit = look_up(made, points, mip, vector(-1, 0, 0))[:, 0].sum()
        dark = look_up(made, points, mip, vector(1, 0, 0))[:, 0].sum()
        assert lit > 0
        assert dark <= 0.001 * lit, mip
