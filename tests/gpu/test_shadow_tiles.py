"""Shadow maps that share layers, and the six of a point light where they meet. SH-09"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.shadow_plan import ShadowSettings
from elemental.scene.model import Light, Scene
from glsl.harness import run_glsl
from gpu.rig import IDENTITY, MakeRig, Rig, at, camera, material, mesh, scene, sun, vector
from shapes import quad, sphere

Array = npt.NDArray[Any]
HIGH = camera(vector(0, 9, 0.01), vector(0, 0, 0), fov_y=0.9)
SCARCE = ShadowSettings(512, budget=4)
"""Ten lamps then have maps of 128 texels, and a spot light one."""


def lamps() -> list[Light]:
    """Ten of a kind over panes of their own, and a spot light."""
    places = [vector(-4 + 2 * (n % 5), 2, -1 + 2 * (n // 5)) for n in range(10)]
    white, down = vector(1, 1, 1), vector(0, -1, 0)
    made = [Light("lamp", "point", white, 1.0, place, down, range=4.0) for place in places]
    spot = replace(made[0], kind="spot", position=vector(4, 2, 1), outer_angle=0.9)
    return [*made, spot]


def court(lights: list[Light]) -> Scene:
    panes = [(mesh(quad(0.5)), at(x, 1, z)) for x in (-4, -2, 0, 2, 4) for z in (-1, 1)]
    return scene(
        (mesh(quad(14.0)), IDENTITY), *panes, materials=[material(double_sided=True)], lights=lights
    )


def visibility(view: Rig, light: int, points: Array, normals: Array) -> Array:
    body, inputs = f"light_visibility({light}u, p, n, 0.0)", {"p": points, "n": normals}
    return run_glsl(view.device, ["lib/shadow.glsl"], body, inputs, reads=view.shadows.reads())


def drawn(view: Rig) -> set[str]:
    """Shadow passes of the next frame."""
    g, _, gb = view.begin()
    g.keep(gb.depth)
    names = {item.name for item in g.passes if item.name.startswith("shadow.")}
    g.execute()
    return names


def test_each_tile_shows_its_own_light_s_shadows(rig: MakeRig) -> None:
    lights = lamps()
    view = rig(court(lights), HIGH, shadow_settings=SCARCE)
    assert len(drawn(view)) == 61
    assert view.shadows.counts == {"shadow_maps": 61, "lights_without_shadow": 0}
    x, z = np.meshgrid(*[np.linspace(-2, 2, 80)] * 2)
    for number, light in enumerate(lights):
        place = light.position
        points = np.stack([x.ravel() + place[0], 0 * x.ravel(), z.ravel() + place[2]], axis=1)
        normals = np.broadcast_to(vector(0, 1, 0), points.shape)
        got = visibility(view, number, points, normals)
        crossing = (points + place) / 2  # at the height of the panes
        centers = np.array([(a, b) for a in (-4, -2, 0, 2, 4) for b in (-1, 1)])
        away = np.abs(crossing[:, None, [0, 2]] - centers).max(axis=2)
        dark = (away < 0.25).any(axis=1)
        assert np.mean((got < 0.5) != dark) < 0.02
        assert abs((1.0 - got).sum() / dark.sum() - 1.0) < 0.08


def test_only_the_tiles_of_a_light_that_moved_are_drawn(rig: MakeRig) -> None:
    world = court(lamps())
    view = rig(world, HIGH, shadow_settings=SCARCE)
    drawn(view)
    before = read_maps(view)
    world.lights[4] = replace(world.lights[4], position=vector(4, 1.8, -1))
    assert drawn(view) == {f"shadow.4.point.{k}" for k in range(6)}
    changed = (read_maps(view) != before).reshape(before.shape[0], 4, 128, 4, 128)
    assert np.count_nonzero(changed.any(axis=(2, 4))) <= 6
    assert changed.any()
    view.camera = camera(vector(0.1, 9, 0.01), vector(0.1, 0, 0), fov_y=0.9)
    assert drawn(view) == set()


def test_a_tile_that_others_drew_over_is_drawn_again(rig: MakeRig) -> None:
    first, others = lamps()[:1], lamps()
    world = court(first)
    view = rig(world, HIGH, shadow_settings=ShadowSettings(256, budget=6))
    assert len(drawn(view)) == 6
    world.lights = others
    assert len(drawn(view)) == 61
    world.lights = first
    assert len(drawn(view)) == 6


def read_maps(view: Rig) -> Array:
    maps = view.shadows.target(view.shadows.planner.plan(
        view.scene.lights, view.gpu.bounds, view.camera, view.size), 0).texture  # fmt: skip
    return np.asarray(maps.read()).copy()


def test_lights_beyond_the_budget_shine_through(rig: MakeRig) -> None:
    """They are counted, and those that stay keep their maps."""
    lights = lamps()
    view = rig(court(lights), HIGH, shadow_settings=ShadowSettings(256, budget=2))
    names = drawn(view)
    assert view.shadows.counts["lights_without_shadow"] == 11 - len(names) // 6 - len(names) % 6
    assert 0 < view.shadows.counts["lights_without_shadow"] < 11
    without = [n for n in range(10) if f"shadow.{n}.point.0" not in names]
    points = np.array([lights[without[0]].position * (1, 0, 1)], np.float32)
    assert visibility(view, without[0], points, vector(0, 1, 0)[None]) == 1.0
    held = next(n for n in range(10) if n not in without)
    points = np.array([lights[held].position * (1, 0, 1)], np.float32)
    assert visibility(view, held, points, vector(0, 1, 0)[None]) == 0.0


def test_suns_share_the_budget(rig: MakeRig) -> None:
    world = scene(
        (mesh(quad(40.0)), IDENTITY),
        lights=[sun(vector(0.5, -1, 0), 1.0), sun(vector(-0.5, -1, 0), 2.0)],
    )
    near = camera(vector(0, 1, 4), vector(0, 0, 0), far=10.0)
    view = rig(world, near, shadow_settings=ShadowSettings(256, budget=7))
    assert {name[:8] for name in drawn(view)} == {"shadow.1"}


MEETINGS = [(1, 1, 0), (0, -1, 1), (-1, 0, -1), (1, 1, 1), (-1, 1, -1), (1, -0.98, 0.3)]


@pytest.mark.parametrize("towards", MEETINGS, ids=str)
def test_a_shadow_crosses_the_faces_of_a_point_light(rig: MakeRig, towards: Any) -> None:
    """A ball in front of an edge or a corner of the cube hides the cone of its own radius: no
    light comes in between the faces, and none is lost."""
    axis = np.array(towards, np.float64) / np.linalg.norm(towards)
    radius, distance = 0.15, 0.6
    lamp = Light("lamp", "point", vector(1, 1, 1), 1.0, vector(0, 0, 0), vector(0, -1, 0))
    world = scene(
        (mesh(sphere(radius, rings=64), smooth=True), at(*(axis * distance))),
        (mesh(quad(0.1)), at(2, 2, 2)),
        (mesh(quad(0.1)), at(-2, -2, -2)),
        lights=[lamp],
    )
    view = rig(world, HIGH)
    drawn(view)
    rng = np.random.default_rng(5)
    spread = rng.normal(size=(40_000, 3)) * 0.25 + axis
    directions = spread / np.linalg.norm(spread, axis=1, keepdims=True)
    got = visibility(view, 0, directions * 1.5, -directions)
    angle = np.arccos(np.clip(directions @ axis, -1, 1))
    rim = np.arcsin(radius / distance)
    texel = 2.0 / 512 * 1.02  # radians in the middle of a face, the coarsest
    assert got[angle < rim - 3 * texel].max() == 0.0
    assert got[angle > rim + 3 * texel].min() > 1.0 - 1e-6
    hidden, wanted = (1.0 - got).sum(), (angle < rim).sum()
    assert abs(hidden / wanted - 1.0) < 0.02
