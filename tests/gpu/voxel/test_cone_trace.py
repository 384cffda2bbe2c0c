# GI-11
"""SVOConeTrace against closed forms: planes, half planes, empty space, and what walls let through.

Where a figure is still beside its goal, its test holds it where it is: docs/gi.md says how far it
has to come.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.voxel.grid import Grid
from gpu.rig import IDENTITY, at, scene, vector
from gpu.voxel.probe import trace
from gpu.voxel.scenes import facing, glowing, part
from gpu.voxel.stage import MakeStage, Stage
from shapes import Shape, box, quad, sphere

Array = npt.NDArray[Any]

GRID = Grid.fit((vector(-1.42, -1.42, -1.42), vector(1.42, 1.42, 1.42)), 64)
VOXEL = GRID.voxel_m
RADIANCE = vector(2.0, 0.5, 0.125)
PLANE_ERROR = 0.03
"""How far any single cone may stray where the sheet lies along the lattice."""


def sheet(stage: MakeStage, normal: Array, shape: Shape | None = None) -> Stage:
    """A glowing sheet of no thickness through the middle: as good as infinite for short cones."""
    placed = part(shape or quad(2.8), 0, facing(normal))
    made: Stage = stage(scene(placed, materials=[glowing(*RADIANCE)]), grid=GRID)
    return made


def shots(rng: np.random.Generator, normal: Array, tilt: float, half_angle: float) -> Array:
    """((N, 3) origins, (N, 3) directions) of cones that meet the sheet wholly inside its rim,
    ``tilt`` radians off its normal."""
    count = 1000
    n, t, b = (facing(normal)[:3, k].astype(np.float64) for k in (1, 0, 2))
    azimuth = rng.uniform(0, 2 * np.pi, (count, 1))
    along = np.cos(azimuth) * t + np.sin(azimuth) * b
    directions = np.sin(tilt) * along - np.cos(tilt) * n
    # The footprint's far end lies tan(tilt + angle) away for each unit of height.
    farthest = min(22.0 / max(np.tan(tilt + half_angle) - np.tan(tilt), 1e-3), 18.0)
    distance = rng.uniform(4.0, farthest, (count, 1)) * VOXEL
    target = rng.uniform(-3, 3, (count, 2)) * VOXEL
    hit = target[:, :1] * t + target[:, 1:] * b
    return np.stack([hit - directions * distance / np.cos(tilt), directions])


def radiance_errors(seen: Array) -> Array:
    """(N,) largest deviation from the sheet's radiance, of its brightest channel."""
    deviation = (seen[:, :3] - RADIANCE) / RADIANCE.max()
    worst = np.abs(deviation).argmax(axis=1)
    return np.asarray(deviation[np.arange(len(worst)), worst])


@pytest.mark.parametrize("half_angle", [0.0, 0.05, 0.2, 0.335, 0.5])
@pytest.mark.parametrize("tilt", [0.0, 0.5, 0.8])
def test_a_cone_into_a_plane_returns_its_radiance(
    stage: MakeStage, tilt: float, half_angle: float
) -> None:
    made, rng = sheet(stage, vector(0, 1, 0)), np.random.default_rng(1)
    origins, directions = shots(rng, vector(0, 1, 0), tilt, half_angle)
    seen = trace(made, origins, directions, half_angle)
    error = radiance_errors(seen)
    rms = np.sqrt((error**2).mean())
    print(f"plane, tilt {tilt}, angle {half_angle}: mean {error.mean():+.4f}, rms {rms:.4f}, "
          f"worst {error.min():+.3f}")  # fmt: skip
    assert np.abs(error).max() <= PLANE_ERROR
    assert (seen[:, 3] <= 1.0).all()


Normal = tuple[int, int, int]
LEAST_OPACITY: dict[Normal, float] = {
    (1, 1, 0): 0.96,
    (1, 1, 1): 0.84,
    (2, 1, 0): 0.97,
    (3, 10, 1): 0.98,
}
"""What a sheet of that normal hides at least, as a mean over cones straight into it."""
LEAST_SHOWN = 0.985


@pytest.mark.parametrize("half_angle", [0.02, 0.335])
@pytest.mark.parametrize("normal", LEAST_OPACITY)
def test_a_slanted_sheet_hides_as_much_as_it_did(
    stage: MakeStage, normal: Normal, half_angle: float
) -> None:
    """And what is seen of it has its radiance, whatever its normal."""
    made, rng = sheet(stage, vector(*normal)), np.random.default_rng(2)
    origins, directions = shots(rng, vector(*normal), 0.0, half_angle)
    seen = trace(made, origins, directions, half_angle)
    hidden, shown = seen[:, 3], seen[:, 0].mean() / (RADIANCE[0] * seen[:, 3].mean())
    print(f"sheet {normal}, angle {half_angle}: {1 - hidden.mean():.3f} leaks, "
          f"{1 - hidden.min():.3f} at worst; {shown:.3f} of its radiance")  # fmt: skip
    assert hidden.mean() >= LEAST_OPACITY[normal]
    assert shown >= LEAST_SHOWN


def coverage_errors(stage: MakeStage, half_angle: float) -> Array:
    """Opacity of a half plane less the covered part of the cone's disc, over many offsets."""
    positions, indices = quad(2.8)
    positions[:, 0] = np.maximum(positions[:, 0], 0.0)
    made = sheet(stage, vector(0, 1, 0), (positions, indices))
    rng, count = np.random.default_rng(3), 4000
    offset = rng.uniform(-1.3, 1.3, count)
    height = rng.uniform(2.5, 8.0, count) / np.tan(half_angle)  # disc radii of 2.5 to 8 voxels
    height = np.minimum(height, 20.0)
    radius = height * np.tan(half_angle)
    p = np.stack([offset * radius, height, rng.uniform(-4, 4, count)], axis=-1) * VOXEL
    hidden = trace(made, p, vector(0, -1, 0), half_angle)[:, 3]
    u = np.clip(offset, -1.0, 1.0)
    covered = 0.5 + (u * np.sqrt(1 - u**2) + np.arcsin(u)) / np.pi
    error = hidden - covered
    print(f"half plane, angle {half_angle}: {np.abs(error).mean():.3f} off in the mean, "
          f"{error.mean():+.3f} too much, worst {np.abs(error).max():.3f}")  # fmt: skip
    return np.asarray(error)


@pytest.mark.parametrize("half_angle", [0.2, 0.335, 0.5])
def test_occlusion_behind_a_half_plane_follows_the_covered_fraction(
    stage: MakeStage, half_angle: float
) -> None:
    error = coverage_errors(stage, half_angle)
    assert np.abs(error).max() <= 0.38
    assert np.abs(error).mean() <= 0.05
    assert np.abs(error.mean()) <= 0.035


def hit_share(
    origins: Array, directions: Array, half_angle: float, meets: Callable[[Array, Array], Array]
) -> Array:
    """(N,) share of rays spread evenly over each cone that meet a body, by its closed form."""
    count = 96
    k = np.arange(count) + 0.5
    up = np.where(np.abs(directions[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    across = np.cross(up, directions)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    along = np.cross(directions, across)
    cosine = 1.0 - (1.0 - np.cos(half_angle)) * k / count
    sine, turn = np.sqrt(1.0 - cosine**2), k * 2.39996323
    rays = cosine[:, None] * directions[:, None] + (sine * np.cos(turn))[:, None] * across[:, None]
    rays += (sine * np.sin(turn))[:, None] * along[:, None]
    return np.asarray(meets(origins[:, None], rays).mean(axis=1))


def meets_ball(radius: float, origins: Array, rays: Array) -> Array:
    """Of a ball around the origin."""
    ahead = -(origins * rays).sum(axis=-1)
    return np.asarray((ahead > 0) & ((origins**2).sum(axis=-1) - ahead**2 < radius**2))


def meets_bars(places: Array, side: float, origins: Array, rays: Array) -> Array:
    """Of square bars along z, 2.6 long, at so many x, through y = 0."""
    hit = np.zeros(np.broadcast_shapes(origins.shape, rays.shape)[:-1], bool)
    for x in places:
        near = np.full_like(hit, -np.inf, np.float64)
        far = -near
        for axis, middle, size in ((0, x, side), (1, 0.0, side), (2, 0.0, 2.6)):
            ends = np.array([middle - size / 2, middle + size / 2])[:, None, None]
            t = (ends - origins[..., axis]) / np.where(rays[..., axis] == 0, 1e-9, rays[..., axis])
            near, far = np.maximum(near, t.min(axis=0)), np.minimum(far, t.max(axis=0))
        hit |= (near < far) & (far > 0)
    return hit


def from_around(rng: np.random.Generator, target: float) -> tuple[Array, Array]:
    """Origins and directions of cones from all sides to places near the middle."""
    d = rng.normal(size=(1500, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    aim = rng.uniform(-target, target, (1500, 3))
    return aim - d * rng.uniform(8.0, 24.0, (1500, 1)) * VOXEL, d


@pytest.mark.parametrize("half_angle", [0.2, 0.335, 0.5])
def test_bodies_hide_what_they_cover_of_a_cone(stage: MakeStage, half_angle: float) -> None:
    """Balls as large as the cone or smaller, and bars that it does not look along: neither too much
    of it nor too little."""
    rng = np.random.default_rng(11)
    errors: dict[str, list[Array]] = {"balls": [], "bars": []}
    for radius in (0.1, 0.2, 0.3):
        made = stage(scene(part(sphere(radius), 0, IDENTITY), materials=[glowing(1.0)]), grid=GRID)
        origins, directions = from_around(rng, 1.5 * radius)
        clear = np.linalg.norm(origins, axis=1) > radius + 2.5 * VOXEL
        origins, directions = origins[clear], directions[clear]
        covered = hit_share(origins, directions, half_angle, partial(meets_ball, radius))
        errors["balls"].append(trace(made, origins, directions, half_angle)[:, 3] - covered)
    for side, gap in ((1.0, 3.1), (2.0, 5.3)):
        places = np.arange(-1.1, 1.1, gap * VOXEL)
        shape = box((side * VOXEL, side * VOXEL, 2.6))
        bars = [part(shape, 0, at(x, 0, 0)) for x in places]
        made = stage(scene(*bars, materials=[glowing(1.0)]), grid=GRID)
        origins, directions = from_around(rng, 0.3)
        clear = (np.abs(origins[:, 1]) > 4 * VOXEL) & (np.abs(directions[:, 1]) > 0.5)
        origins, directions = origins[clear], directions[clear]
        meets = partial(meets_bars, places, side * VOXEL)
        covered = hit_share(origins, directions, half_angle, meets)
        errors["bars"].append(trace(made, origins, directions, half_angle)[:, 3] - covered)
    for name, parts in errors.items():
        error = np.concatenate(parts)
        print(f"{name}, angle {half_angle}: {error.mean():+.3f} too much, "
              f"{np.abs(error).mean():.3f} off in the mean")  # fmt: skip
        assert abs(error.mean()) <= (0.06 if name == "balls" else 0.13)
        assert np.abs(error).mean() <= (0.17 if name == "balls" else 0.23)


def test_empty_space_is_clear_and_black(stage: MakeStage) -> None:
    """Also from outside the cube, and past its sides."""
    corner = part(box((0.3, 0.3, 0.3)), 0, at(-1.2, -1.2, -1.2))
    made = stage(scene(corner, materials=[glowing(1.0)]), grid=GRID)
    rng = np.random.default_rng(4)
    origins = rng.uniform(-0.4, 1.4, (2000, 3))
    away = np.abs(rng.normal(size=(2000, 3))) + 0.1
    for half_angle in (0.0, 0.05, 0.15):
        assert not trace(made, origins, away, half_angle).any()
        assert not trace(made, origins + 3 * GRID.size, away, half_angle).any()


def test_far_walls_are_found_across_empty_nodes(stage: MakeStage) -> None:
    """Steps through empty space skip whole nodes, and never the thin wall behind them."""
    wall = part(quad(2.8), 0, at(0, -1.3, 0))
    made = stage(scene(wall, materials=[glowing(*RADIANCE)]), grid=GRID)
    rng = np.random.default_rng(5)
    origins = np.stack([*rng.uniform(-0.3, 0.3, (2, 3000)), np.zeros(3000)])[[0, 2, 1]].T
    origins[:, 1] = rng.uniform(-1.0, 1.4, 3000)
    directions = np.stack([*rng.uniform(-0.2, 0.2, (2, 3000)), -np.ones(3000)])[[0, 2, 1]].T
    seen = trace(made, origins, directions, 0.0)
    assert np.abs(radiance_errors(seen)).max() <= PLANE_ERROR


def test_the_start_bias_passes_over_what_is_nearer(stage: MakeStage) -> None:
    made = sheet(stage, vector(0, 1, 0))
    origin, down = vector(0.1, 0.2, 0.1), vector(0, -1, 0)
    assert trace(made, origin, down, 0.05)[0, 3] > 0.9
    assert not trace(made, origin, down, 0.05, start=0.2 + 4 * VOXEL).any()


def test_nearer_bodies_hide_farther_ones(stage: MakeStage) -> None:
    """Front to back: of three sheets behind each other the first alone; from behind, none."""
    sheets = [part(quad(2.8), k, at(0, 0.6 - 0.6 * k, 0)) for k in range(3)]
    colors = [glowing(1, 0, 0), glowing(0, 1, 0), glowing(0, 0, 1)]
    made = stage(scene(*sheets, materials=colors), grid=GRID)
    rng = np.random.default_rng(6)
    for half_angle in (0.02, 0.1, 0.25):
        x, z = rng.uniform(-0.2, 0.2, (2, 500))
        above = np.stack([x, np.full(500, 1.2), z], axis=-1)
        first, second, third, hidden = trace(made, above, vector(0, -1, 0), half_angle).mean(axis=0)
        assert first >= 1 - PLANE_ERROR
        assert second <= PLANE_ERROR
        assert third <= 0.01
        assert hidden >= 1 - PLANE_ERROR
        below = trace(made, above * vector(1, -1, 1), vector(0, 1, 0), half_angle).mean(axis=0)
        assert below[:3].max() <= 0.01
        assert below[3] >= 1 - PLANE_ERROR
