"""Scenes that move against still scenes posed alike. GI-06"""

from __future__ import annotations

import gc
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from elemental.gpu.device import Device
from elemental.gpu.resources import Buffer
from elemental.passes import area_lights
from elemental.passes.instance_table import InstanceTable
from elemental.scene import evaluate as evaluation
from elemental.scene.deform import posed
from elemental.scene.model import Instance
from gpu.moving import (
    EYE,
    Array,
    bending_stage,
    picture,
    pose_of,
    stage,
)
from gpu.rig import IDENTITY, UNLIT, at, camera, material, mesh, scene, sun, vector
from gpu.voxel.scenes import colored, glowing
from shapes import quad, sphere


def test_a_moving_scene_looks_like_a_still_one_posed_alike(renderers: Any) -> None:
    """With lights, shadows, area lights and voxels, whatever came before. Bricks may stand
    elsewhere in the atlases, where coordinates round otherwise: few half floats differ by a step.
    Area lights have shadow maps only where they cannot move, so both look through cones.
    """
    cones = {"gi.area_shadows": "cones"}

    def assert_alike(one: Array, other: Array, note: str) -> None:
        np.testing.assert_allclose(one, other, rtol=2.0**-9, atol=2.0**-14, err_msg=note)
        assert (one != other).any(axis=2).mean() < 0.01, note

    world = stage()
    moving = renderers(world, **cones)
    pictures = []
    for t in (0.0, 0.4, 1.2, 1.9, 0.4):
        shown = picture(moving, t)
        still = posed(world, t)
        assert len(still.instances) == (4 if 1.0 <= t < 2.0 else 5)
        assert_alike(shown, picture(renderers(still, **cones), 0.0), str(t))
        pictures.append(shown)
    assert np.abs(pictures[1] - pictures[2])[..., :3].max() > 0.1
    assert_alike(pictures[1], pictures[4], "again")


def test_a_still_scene_has_no_pass_and_no_upload(
    device: Device, renderers: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[str] = []
    write = Buffer.write

    def noted(buffer: Buffer, values: Any, offset: int = 0) -> None:
        if buffer.name.startswith("scene."):
            written.append(buffer.name)
        write(buffer, values, offset)

    monkeypatch.setattr(Buffer, "write", noted)
    for world, moves in ((posed(bending_stage(), 0.0), False), (bending_stage(), True)):
        renderer = renderers(world)
        for _ in range(2):
            written.clear()
            picture(renderer, 0.5)
        device.finish()
        still = [timing.name for timing in device.timings]
        assert written == []
        assert not [n for n in still if "deform" in n or n.startswith(("shadow", "vox"))]
        written.clear()
        renderer.render(EYE, 0.7, 0, "normal")
        device.finish()
        assert ("scene.deform" in [t.name for t in device.timings]) is moves
        assert bool(written) is moves


def test_shadow_maps_follow_what_they_see(device: Device, renderers: Any) -> None:
    """Two lamps in two places; the ball under one of them moves. What stands is drawn once."""
    world = scene((mesh(quad(60.0)), IDENTITY), (mesh(sphere(0.5)), IDENTITY),
                  materials=[material(double_sided=True)])  # fmt: skip
    world.instances[1].dynamic = True
    spot = replace(sun(vector(0, -1, 0)), kind="spot", intensity=9.0, outer_angle=0.4)
    world.lights = [replace(spot, position=vector(x, 5, 0)) for x in (0, 20)]
    renderer = renderers(world)

    def drawn(x: float) -> set[str]:
        pose = pose_of(instances=np.array([1]), world_from_local=at(x, 1, 0)[None],
                       visible=np.array([True]), lights=world.lights)  # fmt: skip
        renderer.read(renderer.render(EYE, 0.0, 0, "direct", pose))
        device.finish()
        return {t.name for t in device.timings if t.name.startswith("shadow.")}

    views = {"shadow.0.spot.0", "shadow.1.spot.0"}
    assert drawn(0.0) == views | {f"{view}.still" for view in views}
    assert drawn(0.0) == set()
    key = renderer._shadows.light_key
    assert drawn(0.5) == {"shadow.0.spot.0"}
    assert renderer._shadows.light_key != key
    assert drawn(10.0) == {"shadow.0.spot.0"}  # left it
    assert drawn(11.0) == set()
    assert drawn(20.0) == {"shadow.1.spot.0"}


def test_nothing_is_evaluated_while_time_stands_still(
    renderers: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """But for what was edited meanwhile: lights and area lights."""
    world = stage()
    renderer = renderers(world)
    asked: list[str] = []
    for module, name in ((evaluation, "evaluate"), (area_lights, "pack_area_lights")):
        made = getattr(module, name)
        monkeypatch.setattr(
            module, name, lambda *args, made=made, name=name: (asked.append(name), made(*args))[1]
        )
    follow = InstanceTable.follow
    monkeypatch.setattr(
        InstanceTable, "follow", lambda *args: (asked.append("follow"), follow(*args))[1]
    )
    everything = ["evaluate", "follow", "pack_area_lights"]
    renderer.render(EYE, 0.4, 0)
    assert asked == everything
    renderer.render(EYE, 0.5, 1)
    assert asked == everything * 2
    before = picture(renderer, 0.5)  # in which they come to rest
    assert asked == [*everything * 2, "follow"]
    picture(renderer, 0.5)
    assert asked == [*everything * 2, "follow"]
    world.lights[0] = replace(world.lights[0], intensity=3.0)
    shown = picture(renderer, 0.5)
    assert (shown != before).mean() > 0.1
    np.testing.assert_array_equal(shown, picture(renderers(world), 0.5))
    asked.clear()
    renderer.set_material(3, replace(world.materials[3], emissive=vector(1, 2, 9)))
    shown = picture(renderer, 0.5)
    assert asked == ["pack_area_lights"] * 2
    np.testing.assert_array_equal(shown, picture(renderers(world), 0.5))


def test_what_comes_into_view_is_drawn(renderers: Any) -> None:
    world = scene((mesh(quad(4.0)), IDENTITY), (mesh(sphere(0.5, rings=8)), IDENTITY))
    world.instances[1].dynamic = True
    renderer = renderers(world)

    def covered(x: float) -> int:
        pose = pose_of(instances=np.array([1]), world_from_local=at(x, 2, 0)[None],
                       visible=np.array([True]))  # fmt: skip
        shown = renderer.read(renderer.render(EYE, 0.0, 0, "scene_color", pose))
        return int((shown[:16, :, 3] > 0.0).sum())  # above the floor

    assert covered(30.0) == 0
    assert covered(0.0) > 50
    assert covered(30.0) == 0


def test_a_new_material_is_the_scene_s_and_changes_its_users(renderers: Any) -> None:
    """Emission and colour, a lamp that goes dark, and other draw state: the same as made anew."""
    world = stage()
    renderer = renderers(world)
    before = picture(renderer, 0.5)
    for index, new in (
        (2, colored(0.9, 0.1, 0.1)),
        (2, glowing(0, 3, 0)),
        (2, glowing(0, 30, 0)),  # brighter than what the voxels were made for
        (3, material(base_color=vector(3, 2, 1, 1), definition=UNLIT)),  # was an area light
        (3, colored(0.5, 0.5, 0.5)),
        (1, material(base_color=vector(0.2, 0.9, 0.2, 0.5), alpha_mode="blend")),
        (1, material(base_color=vector(0.2, 0.9, 0.2, 1.0), double_sided=True)),
    ):
        renderer.set_material(index, new)
        renderer.render(EYE, 0.5, 0, "scene_color")
        changed = {change.instance for change in renderer._meshes.changes}
        users = {n for n, i in enumerate(world.instances) if world.meshes[i.mesh].material == index}
        assert changed == users
        shown = picture(renderer, 0.5)
        assert np.abs(shown - before).max() > 0.01
        np.testing.assert_array_equal(shown, picture(renderers(world), 0.5), str(index))
        before = shown


def test_a_colour_change_draws_no_shadow_map(device: Device, renderers: Any) -> None:
    renderer = renderers(stage())
    picture(renderer, 0.5)
    for new, redraws in (
        (colored(0.9, 0.1, 0.1), False),
        (material(base_color=vector(1, 1, 1, 0.2), alpha_mode="mask"), True),
    ):
        renderer.set_material(2, new)
        renderer.render(EYE, 0.5, 0)
        device.finish()
        drawn = [t.name for t in device.timings if t.name.startswith("shadow.")]
        assert bool(drawn) is redraws


def test_a_ball_s_shadow_follows_it(renderers: Any) -> None:
    """Under a sun at 45 degrees it lies as far beside the ball as that is high."""
    world = scene((mesh(quad(8.0)), IDENTITY), (mesh(sphere(0.4, rings=8)), IDENTITY),
                  lights=[sun(vector(1, -1, 0))])  # fmt: skip
    world.instances[1] = Instance("ball", 1, at(0, 3, 0), dynamic=True)
    high = camera(vector(0, 12, 0.01), vector(0, 0, 0), fov_y=0.45)
    renderer = renderers(world)
    for x in (-2.5, -2.0, -1.0):
        pose = pose_of(instances=np.array([1]), world_from_local=at(x, 2, 0)[None],
                       visible=np.array([True]), lights=world.lights)  # fmt: skip
        frame = renderer.render(high, 0.0, 0, "shadow", pose)
        dark = renderer.read(frame)[..., 0] < 0.5
        height, width = dark.shape
        metres = 2 * 12 * np.tan(0.225) / height
        floor_x = (np.arange(width) + 0.5 - width / 2) * metres
        dark &= floor_x > x + 1.2  # the ball's own dark side is left of there
        assert floor_x[np.nonzero(dark)[1]].mean() == pytest.approx(x + 2.0, abs=0.1)


def test_frames_leave_nothing_to_the_cycle_collector(renderers: Any) -> None:
    """Which therefore may come rarely (core/collector.py)."""
    renderer = renderers(stage())
    try:
        for number in range(16):
            if number == 6:
                gc.collect()
                gc.disable()
            renderer.render(EYE, 0.05 * number, number)
            renderer.device.finish()
        unreachable = gc.collect()
    finally:
        gc.enable()
    assert unreachable < 50  # ctypes leaves some when it makes a type
