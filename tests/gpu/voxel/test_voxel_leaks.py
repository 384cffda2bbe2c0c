# GI-11 GI-16
"""What users of voxel lighting complain of first: light through walls, and brightness that depends
on the resolution.

Goals that are not met yet are expected to fail; beside each, a test holds what is reached.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.voxel.grid import Grid
from elemental.scene.model import Environment, Light, Mesh, Scene
from gpu.rig import at, mesh, scene, sun, vector
from gpu.voxel.pools import Pools, leaf_values
from gpu.voxel.probe import gather
from gpu.voxel.scenes import TURNS, colored, facing, glowing, part
from gpu.voxel.stage import MakeStage, Stage
from shapes import box, inward

Array = npt.NDArray[Any]

INSIDE = 1.7
"""Side of a room, m."""
GRID = Grid.fit((vector(-1.45, -1.45, -1.45), vector(1.45, 1.45, 1.45)), 64)
SKY = Environment(None, vector(1, 1, 1), 1.0)
SUN = sun(vector(0.4, -1.0, 0.3), 5.0)


def room(
    stage: MakeStage, turn: Array, wall_voxels: float, sky: Environment | None, *lights: Light
) -> Stage:
    """A closed white box without a lamp, its walls so many voxels thick; 0: sheets."""
    parts = [part(inward(box((INSIDE,) * 3)), 0, turn)]
    if wall_voxels:
        parts.append(part(box((INSIDE + 2 * wall_voxels * GRID.voxel_m,) * 3), 0, turn))
    white = scene(*parts, materials=[colored(0.8, 0.8, 0.8)], lights=lights, environment=sky)
    made: Stage = stage(white, grid=GRID)
    return made


def arriving(stage: Stage, turn: Array) -> Array:
    """(N,) gathered light at points of the room's inner walls."""
    rng, count = np.random.default_rng(8), 600
    axis, side = rng.integers(0, 3, count), rng.choice([-1, 1], count)
    p, normal = rng.uniform(-0.7, 0.7, (count, 3)), np.zeros((count, 3))
    p[np.arange(count), axis] = side * INSIDE / 2
    normal[np.arange(count), axis] = -side
    rotation = turn[:3, :3].astype(np.float64).T
    return gather(stage, p @ rotation, normal @ rotation)[:, 0]


REACHED = {
    ("straight", 0): 0.011,
    ("straight", 2): 0.0018,
    ("straight", 4): 0.001,
    ("turned", 0): 0.0065,
    ("turned", 2): 0.001,
    ("turned", 4): 0.001,
    ("diagonal", 0): 0.0125,
    ("diagonal", 2): 0.0036,
    ("diagonal", 4): 0.001,
}
"""Share of the sky's light that gets in, as a mean, by the room's turn and its walls' voxels."""


@pytest.mark.parametrize(("turn", "wall"), REACHED)
def test_little_of_the_sky_gets_into_a_closed_room(stage: MakeStage, turn: str, wall: int) -> None:
    light = arriving(room(stage, TURNS[turn], wall, SKY), TURNS[turn])
    print(f"sky in a {turn} room, walls of {wall}: {light.mean():.4f}, {light.max():.4f} at most")
    assert light.mean() <= REACHED[turn, wall]
    assert light.max() <= 6.0 * REACHED[turn, wall] + 0.08


SUNLIT = 5.0 * 0.8 / np.pi
"""Radiance of a white wall that faces the sun."""


@pytest.mark.parametrize("wall", [2, 4])
@pytest.mark.parametrize("turn", TURNS)
def test_little_of_a_sunlit_outside_shows_inside(stage: MakeStage, turn: str, wall: int) -> None:
    light = arriving(room(stage, TURNS[turn], wall, None, SUN), TURNS[turn]) / SUNLIT
    print(f"sun in a {turn} room, walls of {wall}: {light.mean():.4f}, {light.max():.4f} at most")
    assert light.mean() <= 0.045
    assert light.max() <= 0.12


@pytest.mark.parametrize("turn", TURNS)
def test_the_sun_lights_no_voxel_inside(stage: MakeStage, turn: str) -> None:
    """Shadow maps hold behind walls of four voxels."""
    made = room(stage, TURNS[turn], 4, None, SUN)
    pools, (radiance, _) = Pools.read(made), leaf_values(made)
    leaves = pools.cell[pools.level == GRID.leaf_level]
    corners = np.array([[k & 1, k >> 1 & 1, k >> 2] for k in range(8)])
    p = made.world(2 * leaves[:, None] + corners) @ TURNS[turn][:3, :3].astype(np.float64)
    inside = (np.abs(p) < INSIDE / 2 + GRID.voxel_m).all(axis=-1) & (radiance[..., 3] > 0)
    assert inside.sum() > 5000
    assert radiance[inside][:, :3].max() == 0.0
    assert radiance[~inside][:, :3].max() > 0.5 * SUNLIT


def lamp_room() -> Scene:
    """A room of several voxels' walls, a lamp of 0.6 m under its ceiling, a block on its floor."""

    def slab(normal: tuple[float, float, float], material: int) -> tuple[Mesh, Array]:
        turn = facing(vector(*normal))
        return mesh(box((2.4, 0.2, 2.4)), material), turn @ at(0, -1.1, 0)

    walls = [slab(n, 0) for n in ((0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]
    walls += [slab((1, 0, 0), 1), slab((-1, 0, 0), 2)]
    lamp = part(box((0.6, 0.1, 0.6)), 3, at(0, 0.85, 0))
    block = part(box((0.5, 0.6, 0.5)), 0, at(0.3, -0.7, 0.2))
    colors = [colored(0.75, 0.75, 0.75), colored(0.6, 0.1, 0.1), colored(0.1, 0.5, 0.1)]
    return scene(*walls, lamp, block, materials=[*colors, glowing(10.0)])


def test_brightness_hardly_depends_on_the_resolution(stage: MakeStage) -> None:
    """Irradiance on floor and walls of a lamp-lit room at 64, 128 and 256 lattice points."""
    rng, count = np.random.default_rng(9), 400
    across = rng.uniform(-0.8, 0.8, (2, count))
    one = np.ones(count)
    places = {
        "floor": (np.stack([across[0], -one, across[1]], axis=-1), vector(0, 1, 0)),
        "wall": (np.stack([-one, *across], axis=-1), vector(1, 0, 0)),
        "back": (np.stack([*across, -one], axis=-1), vector(0, 0, 1)),
    }
    light: dict[str, list[float]] = {name: [] for name in places}
    for resolution in (64, 128, 256):
        made = stage(lamp_room(), resolution)
        for name, (p, normal) in places.items():
            light[name].append(float(gather(made, p, normal)[:, 0].mean()))
    for name, values in light.items():
        ratios = np.array(values) / values[1]
        print(f"{name} at 64, 128, 256: {values[1]:.4f} x {ratios.round(3)}")
        assert ratios.min() >= 0.8, name
        assert ratios.max() <= 1.25, name
