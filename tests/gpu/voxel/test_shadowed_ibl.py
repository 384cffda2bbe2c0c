# GI-14
"""What a cone does not hit, it takes from the prefiltered environment at its own width."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.scene.model import Environment
from glsl.harness import run_glsl
from gpu.rig import at, scene, vector
from gpu.test_sky import pixel_directions
from gpu.voxel.probe import gather
from gpu.voxel.scenes import colored, part
from gpu.voxel.stage import MakeStage, Stage
from shapes import box, quad

Array = npt.NDArray[Any]
LEFT, RIGHT = 0.5, 2.0
"""Radiance of the sky's two halves, x < 0 and x > 0."""


def halves() -> Environment:
    directions = pixel_directions(64)
    radiance = np.where(directions[..., :1] > 0.0, RIGHT, LEFT) * np.ones(3)
    return Environment(radiance.astype(np.float32), vector(1, 1, 1), 1.0)


def court(stage: MakeStage, *walls: float) -> Stage:
    """A black floor of 4 m under the sky, with a black wall 2.4 m high at each of these x."""
    parts = [part(quad(4.0), 0, at(0, 0, 0))]
    parts += [part(box((0.2, 2.4, 4.0)), 0, at(x, 1.2, 0)) for x in walls]
    return stage(scene(*parts, materials=[colored(0, 0, 0)], environment=halves()), resolution=64)


ALONG = """
vec4 along(vec3 p, vec3 d, float a) {
    vec4 cone = SVOConeTrace(p, d, a);
    return vec4(cone.rgb + (1.0 - cone.a) * sky_radiance(d, a), cone.a);
}
"""


def cones(stage: Stage, direction: Array, half_angle: Array) -> Array:
    """(N, 4) radiance along cones from a metre above the floor, and how much is hidden."""
    count = len(half_angle)
    return run_glsl(
        stage.device,
        ["lib/cone.glsl", "lib/sky.glsl"],
        "along(p, d, a)",
        {
            "p": np.tile(vector(0, 1, 0), (count, 1)),
            "d": np.broadcast_to(direction, (count, 3)).astype(np.float32),
            "a": half_angle.astype(np.float32),
        },
        "vec4",
        functions=ALONG,
        reads={**stage.octree.tracing_reads(), **stage.sky.reads()},
        params={**stage.octree.params, **stage.sky.params()},
    )


def test_a_clear_cone_sees_the_mean_of_the_sky_within_it(stage: MakeStage) -> None:
    """A cone along the border of the halves sees their mean at any width.

    One beside it sees its own half while it is narrow, and a share of the other when it is wide.
    """
    made = court(stage)
    angles = np.array([0.05, 0.2, 0.5])
    border = cones(made, vector(0, 1, 0), angles)
    assert border[:, 3].max() == 0.0
    np.testing.assert_allclose(border[:, 0], (LEFT + RIGHT) / 2, rtol=0.05)
    off = 0.3
    beside = cones(made, vector(np.sin(off), np.cos(off), 0), angles)[:, 0]
    np.testing.assert_allclose(beside[:2], RIGHT, rtol=0.05)
    u = off / angles[2]
    own = 0.5 + (u * np.sqrt(1 - u * u) + np.arcsin(u)) / np.pi
    assert beside[2] == pytest.approx(own * RIGHT + (1 - own) * LEFT, rel=0.1)


def test_a_wall_hides_its_side_of_the_sky(stage: MakeStage) -> None:
    wall = court(stage, 1.0)
    towards = cones(wall, vector(1, 0, 0), np.array([0.1, 0.3]))
    assert towards[:, 0].max() <= 0.03 * RIGHT
    away = cones(wall, vector(-1, 0.5, 0) / np.sqrt(1.25), np.array([0.1, 0.3]))
    np.testing.assert_allclose(away[:, 0], LEFT, rtol=0.05)


def exact(x: float, walls: tuple[float, ...]) -> float:
    """Cosine-weighted mean of the sky seen from (x, 0, 0) on the floor, by rays."""
    rng = np.random.default_rng(5)
    r, turn = np.sqrt(rng.random(200_000)), rng.uniform(0, 2 * np.pi, 200_000)
    d = np.stack([r * np.cos(turn), np.sqrt(1 - r * r), r * np.sin(turn)], axis=-1)
    seen = np.where(d[:, 0] > 0, RIGHT, LEFT)
    for wall in walls:
        face = wall - np.copysign(0.1, wall - x)
        t = (face - x) / d[:, 0]
        y, z = t * d[:, 1], t * d[:, 2]
        seen = np.where((t > 0) & (y < 2.4) & (np.abs(z) < 2.0), 0.0, seen)
    return float(seen.mean())


@pytest.mark.parametrize(
    ("walls", "mean", "worst"),
    [((), 0.01, 0.02), ((1.0,), 0.07, 0.24), ((-1.0, 1.0), 0.15, 0.35)],
    ids=["none", "one", "two"],
)
def test_the_floor_gathers_what_the_walls_leave_of_the_sky(
    stage: MakeStage, walls: tuple[float, ...], mean: float, worst: float
) -> None:
    """The relative errors reached: wide cones hide too much beside walls (docs/gi.md)."""
    made = court(stage, *walls)
    x = np.linspace(-0.6, 0.6, 13)
    p = np.stack([x, 0 * x, 0 * x], axis=-1)
    found = gather(made, p, vector(0, 1, 0))[:, 0]
    wanted = np.array([exact(float(v), walls) for v in x])
    errors = found / wanted - 1.0
    print(f"walls {walls}: {errors.mean():+.3f} in the mean, {np.abs(errors).max():.3f} at worst")
    assert abs(errors.mean()) <= mean
    assert np.abs(errors).max() <= worst
