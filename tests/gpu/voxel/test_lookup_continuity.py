# GI-10
"""SVOLookupLevel along dense lines: no jump where a line goes from one brick to the next."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from gpu.rig import vector
from gpu.voxel.pools import Pools
from gpu.voxel.probe import look_up
from gpu.voxel.stage import Stage

Array = npt.NDArray[Any]

STEP = 0.01
"""Of a voxel."""
LINES, SAMPLES = 60, 1500
STEEPEST = 2.0 * STEP * np.sqrt(3.0)
"""Twice what trilinear interpolation alone changes over such a step: a slanted layer's voxels count
for more, and so do three sides that a ray sees at once."""
SLANTED = 5.0
"""So much more may colour change: it is shown by ratios of covers."""
COARSE, COARSE_JUMP = 4, 0.35
"""From this level on few codes cover a voxel of the scene; their ratios jump inside a brick."""
CODE = 1.0 / 255.0


def lines(stage: Stage, mip: int) -> Array:
    """(LINES, SAMPLES, 3) world points of lines through the scene, STEP voxels apart."""
    rng = np.random.default_rng(mip)
    directions = rng.normal(size=(LINES, 1, 3))
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    middle = jumbled_points(stage, rng)
    along = (np.arange(SAMPLES) - SAMPLES / 2)[:, None] * STEP * 2**mip * stage.own_grid.voxel_m
    return np.asarray(middle[:, None] + along * directions)


def jumbled_points(stage: Stage, rng: np.random.Generator) -> Array:
    """(LINES, 3) world points on the scene's surfaces."""
    points = rng.choice(stage.fragment_points, LINES) + stage.own_grid.resolution // 2
    return stage.world(points + rng.uniform(-0.5, 0.5, (LINES, 3)))


@pytest.mark.parametrize("mip", range(7))
@pytest.mark.parametrize("direction", [(0, 0, 1), (-1, 0, 0), (0.6, -0.48, 0.64)])
def test_a_border_is_crossed_without_a_jump(
    jumbled: Stage, mip: int, direction: tuple[float, float, float]
) -> None:
    p = lines(jumbled, mip)
    value = look_up(jumbled, p.reshape(-1, 3), mip, vector(*direction)).reshape(*p.shape[:2], 4)
    lattice = jumbled.lattice(p)
    inside_cube = np.all(np.abs(lattice / jumbled.own_grid.resolution - 1.0) < 1.0, axis=-1)
    cells = np.floor(lattice / 2 ** (mip + 1)).astype(int)
    crossing = (np.diff(cells, axis=1) != 0).any(axis=-1)
    scale = scales_along(jumbled, cells, mip)
    largest = np.maximum(np.maximum(scale[:, 1:], scale[:, :-1]), 1e-9)
    jump = (
        np.abs(np.diff(value, axis=1))
        * np.minimum(inside_cube[:, 1:], inside_cube[:, :-1])[..., None]
    )
    jump[..., :3] /= largest[..., None]
    assert value[..., 3].max() > 0.1
    for channel, name in ((3, "opacity"), (slice(0, 3), "colour")):
        across, inside = (jump[where][:, channel].max() for where in (crossing, ~crossing))
        print(f"mip {mip}, {name}: {across:.4f} across, {inside:.4f} inside")
        if name == "opacity":
            assert max(across, inside) <= STEEPEST + CODE
        elif mip > 0:  # the finest level's colour turns with the normal, too
            most = SLANTED * STEP * np.sqrt(3.0) + CODE
            assert max(across, inside) <= (most if mip < COARSE else COARSE_JUMP)
        # Colour is rounded by each brick's own multiplier, by half a code of either.
        assert across <= inside + (CODE if name == "colour" else 0.0), name


def scales_along(stage: Stage, cells: Array, mip: int) -> Array:
    """The multiplier of each cell's brick, 0 where it has none."""
    pools = Pools.read(stage)
    brick = pools.brick_at(cells.reshape(-1, 3), stage.own_grid.leaf_level - mip)
    return np.where(brick >= 0, pools.scale[brick], 0.0).reshape(cells.shape[:2])


def test_nothing_is_found_outside_the_cube(jumbled: Stage) -> None:
    low, size = jumbled.own_grid.origin, jumbled.own_grid.size
    outside = (
        np.array([[-0.01, 0.5, 0.5], [0.5, 1.01, 0.5], [2, 2, 2], [0.5, 0.5, -3]]) * size + low
    )
    for mip in range(9):
        assert not look_up(jumbled, outside, mip, vector(0, 0, 1)).any()
