"""Emissive faces and balls light surfaces and are shadowed by what stands before them. GI-15"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.gpu.device import Device
from elemental.passes.area_lights import pack_area_lights
from elemental.scene.area_lights import AreaLight, area_lights
from elemental.scene.model import Scene
from glsl.harness import run_glsl
from gpu.rig import at, mesh, scene, vector
from gpu.voxel.scenes import colored, glowing, part, turned
from gpu.voxel.stage import Stage
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
TILTS = {"straight": 0.0, "turned": 0.4, "diagonal": np.pi / 4}


def room(tilt: float, blocker: float | None) -> Scene:
    """A floor, a lamp of side 1 two metres above it, half way a black square of side ``blocker``.

    All are turned about the z axis.
    """
    turn = turned(vector(0, 0, 1), tilt)
    parts = [
        part(box((4, 0.2, 4)), 0, turn @ at(0, -0.1, 0)),
        part(quad(), 1, turn @ at(0, 2, 0) @ turned(vector(1, 0, 0), np.pi)),
    ]
    if blocker is not None:
        parts.append(part(box((blocker, 0.1, blocker)), 0, turn @ at(0, 1, 0)))
    return scene(*parts, materials=[colored(0, 0, 0), glowing(10.0)])


ARRIVES = """
vec2 arrives(vec3 p, vec3 n) {
    vec2 sum = vec2(0.0);
    for (int k = 0; k < AREA_STRATA; ++k) {
        AreaSample s = sample_area_lights(p, n, k);
        if (s.face < 0) continue;
        sum += s.irradiance.x * vec2(area_visibility(p, n, s), 1.0);
    }
    return sum / float(AREA_STRATA);
}
"""


def arrives(stage: Stage, lights: list[AreaLight], p: Array, normal: Array) -> Array:
    """(N, 2) irradiance with and without shadow."""
    p, normal = np.broadcast_arrays(np.atleast_2d(p), np.atleast_2d(normal))
    return run_glsl(
        stage.device,
        ["lib/area_shadow.glsl"],
        "arrives(p, n)",
        {"p": p.astype(np.float32), "n": normal.astype(np.float32)},
        "vec2",
        functions=ARRIVES,
        reads=stage.octree.tracing_reads(),
        params={"AreaLights": pack_area_lights(lights), **stage.octree.params},
    )


def floor_points(tilt: float, x: Array) -> tuple[Array, Array]:
    turn = turned(vector(0, 0, 1), tilt)[:3, :3]
    return np.stack([x, 0 * x, 0 * x], axis=-1) @ turn.T, turn @ np.array([0, 1, 0])


@pytest.mark.parametrize("tilt", TILTS.values(), ids=TILTS)
def test_an_open_floor_gets_the_closed_form(device: Device, tilt: float) -> None:
    """The lamp's own voxels and the floor's don't hide it, at any slant."""
    lit = room(tilt, None)
    stage = Stage(device, lit, 64)
    p, normal = floor_points(tilt, np.linspace(-1.8, 1.8, 37))
    found = arrives(stage, area_lights(lit), p, normal)
    stage.release()
    np.testing.assert_allclose(found[:, 0], found[:, 1], rtol=0.02)
    under = 4.0 * 0.25 / np.sqrt(1.0625) * np.arctan(0.25 / np.sqrt(1.0625))
    assert found[18, 0] == pytest.approx(10.0 * under, rel=0.02)


def seen_share(p_x: Array, blocker: float) -> Array:
    """Share of the lamp's irradiance that passes the blocker's box, by rays to a grid of points."""
    s = (np.arange(60) + 0.5) / 60 - 0.5
    x, z = np.meshgrid(s, s, indexing="ij")
    shares = []
    for px in p_x:
        squared = (x - px) ** 2 + z**2 + 4.0
        weight = 4.0 / squared**2
        open_ = np.ones_like(x, bool)
        for y in (0.95, 1.05):
            t = y / 2.0
            open_ &= (np.abs(px + t * (x - px)) > blocker / 2) | (np.abs(t * z) > blocker / 2)
        shares.append((weight * open_).sum() / weight.sum())
    return np.array(shares)


@pytest.mark.parametrize("tilt", TILTS.values(), ids=TILTS)
def test_an_occluder_throws_its_umbra_and_penumbra(device: Device, tilt: float) -> None:
    lit = room(tilt, 0.8)
    stage = Stage(device, lit, 128)
    x = np.linspace(-1.8, 1.8, 73)
    found = arrives(stage, area_lights(lit), *floor_points(tilt, x))
    stage.release()
    share = found[:, 0] / found[:, 1]
    exact = seen_share(x, 0.8)
    assert share[exact == 0.0].max() < 0.03
    assert share[exact == 1.0].min() > 0.9
    # A body's voxels reach about a voxel beyond it, here 4 % of the occluder's side at either end.
    assert np.abs(share - exact).mean() < 0.08


def under_a_ball(blocker: float | None) -> Scene:
    """`room` with a ball of 0.8 m in the lamp's place."""
    lit = room(0.0, blocker)
    lit.meshes[1], lit.instances[1].world_from_local = mesh(sphere(0.4, 24), 1), at(0, 2, 0)
    return lit


def test_an_open_floor_gets_all_of_a_balls_light(device: Device) -> None:
    """The ball's own voxels and the floor's don't hide it."""
    lit = under_a_ball(None)
    stage = Stage(device, lit, 64)
    x = np.linspace(-1.8, 1.8, 37)
    found = arrives(stage, area_lights(lit), *floor_points(0.0, x))
    stage.release()
    np.testing.assert_allclose(found[:, 0], found[:, 1], rtol=0.02)
    squared = 4.0 + x**2
    np.testing.assert_allclose(found[:, 1], 10 * np.pi * 0.16 * 2 / squared**1.5, rtol=0.02)


def test_an_occluder_hides_a_ball(device: Device) -> None:
    lit = under_a_ball(0.8)
    stage = Stage(device, lit, 128)
    x = np.linspace(-1.8, 1.8, 73)
    found = arrives(stage, area_lights(lit), *floor_points(0.0, x))
    stage.release()
    share = found[:, 0] / found[:, 1]
    rng = np.random.default_rng(5)
    surface = rng.normal(size=(4000, 3))
    surface *= 0.4 / np.linalg.norm(surface, axis=1, keepdims=True)
    exact = np.array([_open(px, surface + vector(0, 2, 0)) for px in x])
    assert share[exact == 0.0].max() < 0.03
    assert share[exact == 1.0].min() > 0.9
    assert np.abs(share - exact).mean() < 0.08


def _open(px: float, points: Array) -> float:
    """Share of the directions to a ball's points in front that pass the box at 1 m."""
    path = points - [px, 0, 0]
    front = (path * (points - [0, 2, 0])).sum(1) < 0.0
    facing = np.where(front, -(path * (points - [0, 2, 0])).sum(1), 0.0)
    weight = facing * path[:, 1] / (path**2).sum(1) ** 2
    passes = np.ones(len(points), bool)
    for y in (0.95, 1.05):
        at_y = path * (y / path[:, 1:2])
        passes &= (np.abs(px + at_y[:, 0]) > 0.4) | (np.abs(at_y[:, 2]) > 0.4)
    return float((weight * passes).sum() / weight.sum())
