"""Scenes that move: poses on the device against numpy and against still scenes. GI-06"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.gpu.resources import Buffer
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import SURFACE_VERTEX
from elemental.scene.deform import deformed, posed
from elemental.scene.evaluate import Pose, evaluate
from elemental.scene.extent import settle
from elemental.scene.model import Instance, Mesh, Scene
from elemental.scene.motion import Influences, Morphs, RigBuilder, Skin, Tracks
from elemental.settings import Settings
from gpu.rig import IDENTITY, at, camera, material, mesh, scene, sun, vector
from gpu.voxel.scenes import colored, glowing
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
SIZE = (64, 48)
SETTINGS = Settings().replace({"gi.resolution": 64, "shadow.resolution": 256})
EYE = camera(vector(0, 3, 6), vector(0, 0.5, 0))


def slide(node: int, *points: tuple[float, float, float]) -> Tracks:
    """A point a second."""
    times = np.arange(len(points), dtype=np.float64)
    return Tracks("translation", np.array([node]), times, np.array([points]), "linear", times[-1])


def turn(node: int, seed: int) -> tuple[Tracks, Tracks]:
    """Uneven turning and stretching for two seconds."""
    rng, times = np.random.default_rng(seed), np.array([0.0, 1.0, 2.0])
    turns = rng.normal(0, 1, (1, 3, 4))
    turns /= np.linalg.norm(turns, axis=2, keepdims=True)
    scales = rng.uniform(0.6, 1.2, (1, 3, 3))
    return (
        Tracks("rotation", np.array([node]), times, turns, "linear", 2.0),
        Tracks("scale", np.array([node]), times, scales, "linear", 2.0),
    )


def blink(node: int, *shown: float) -> Tracks:
    times = np.arange(len(shown), dtype=np.float64)
    values = np.array(shown)[None, :, None]
    return Tracks("visible", np.array([node]), times, values, "step", times[-1])


def stage() -> Scene:
    """A floor and a still box; a tumbling ball, a glowing sheet that sinks, a box that vanishes
    after a second, and a lamp that moves."""
    made = scene(
        (mesh(quad(6.0)), IDENTITY),
        (mesh(box((0.5, 2, 0.5)), 1), at(-1.5, 1, -1)),
        (mesh(sphere(0.5), 2, smooth=True), IDENTITY),
        (mesh(quad(0.8), 3), IDENTITY),
        (mesh(box((0.6, 0.6, 0.6)), 1), IDENTITY),
        materials=[colored(0.8, 0.8, 0.8), colored(0.7, 0.2, 0.1), colored(0.2, 0.4, 0.8),
                   replace(glowing(9, 7, 5), double_sided=True)],
        lights=[sun(vector(0.3, -1, -0.4), 1.0)],
    )  # fmt: skip
    builder = RigBuilder()
    ball, sheet, cube, lamp = (builder.node() for _ in range(4))
    builder.tracks = [
        slide(ball, (-1, 0.5, 1), (1, 0.5, 1), (1, 0.5, -1)),
        *turn(ball, 1),
        slide(sheet, (1.5, 2.5, 0), (1.5, 1.5, 0), (1, 1, 0)),
        slide(cube, (0, 0.3, 0), (0, 0.3, 0.5), (0, 0.3, 1)),
        blink(cube, 1, 0, 1),
        slide(lamp, (0, 2, 0), (1, 2, 1), (0, 2, 0)),
    ]
    for instance, node in zip(made.instances[2:], (ball, sheet, cube), strict=True):
        instance.dynamic, instance.node = True, node
    spot = replace(sun(vector(0, -1, 0)), name="lamp", kind="point", intensity=2.0, node=lamp)
    made.lights.append(spot)
    made.motion = builder.motion()
    settle(made)
    return made


def bent(seed: int, joints: int, targets: int) -> Mesh:
    """A ball whose vertices hang on random joints and have random morph targets."""
    rng = np.random.default_rng(seed)
    made = mesh(sphere(0.7, rings=9), smooth=True)
    count = len(made.positions)
    if joints:
        weights = rng.random((count, 4)) * (rng.random((count, 4)) < 0.6)
        weights[:, 0] += 0.1
        weights /= weights.sum(axis=1, keepdims=True)
        held = rng.integers(0, joints, (count, 4)).astype(np.int32)
        made = replace(made, influences=Influences(held, weights.astype(np.float32)))
    if targets:
        deltas = rng.normal(0, 0.1, (3, targets, count, 3)).astype(np.float32)
        made = replace(made, morphs=Morphs(*deltas))
    return made


def bending_stage() -> Scene:
    """A floor; a skinned and morphed ball, twice with weights of their own; a morphed one; a
    skinned one with eight joints a vertex."""
    both, morphed, eight = bent(1, 3, 2), bent(2, 0, 3), bent(3, 3, 0)
    assert eight.influences is not None
    held = eight.influences
    eight.influences = Influences(
        np.concatenate([held.joints, held.joints[:, ::-1]], 1),
        np.concatenate([held.weights, held.weights[:, ::-1]], 1) / 2,
    )
    made = scene((mesh(quad(8.0)), IDENTITY), (both, IDENTITY), (morphed, at(-2, 1, 0)),
                 (eight, IDENTITY))  # fmt: skip
    builder = RigBuilder()
    rng = np.random.default_rng(5)
    joints = [builder.node(translation=[k - 1, 1, 0]) for k in range(3)]
    builder.tracks = [slide(j, *(rng.normal(0, 0.5, (3, 3)) + vector(j - 1, 1, 0))) for j in joints]
    builder.tracks += [track for joint in joints for track in turn(joint, joint)]
    first, second, other = (builder.node() for _ in range(3))
    for node, count in ((first, 2), (second, 2), (other, 3)):
        values = rng.normal(0, 0.7, (1, 3, count))
        times = np.array([0.0, 1.0, 2.0])
        builder.tracks.append(Tracks("weights", np.array([node]), times, values, "linear", 2.0))
    inverse = np.array([at(1 - k, -1, 0) for k in range(3)], np.float64)
    builder.skins = [Skin(np.array(joints), inverse)]
    made.motion = builder.motion()
    _, ball, lump, worm = made.instances
    ball.dynamic, ball.node, ball.skin, ball.weights = True, first, 0, np.zeros(2, np.float32)
    lump.dynamic, lump.node, lump.weights = True, other, np.zeros(3, np.float32)
    worm.dynamic, worm.skin = True, 0
    twin = replace(ball, node=second, weights=np.zeros(2, np.float32))
    made.instances.append(twin)
    settle(made)
    return made


@pytest.fixture
def renderers(device: Device) -> Iterator[Any]:
    """Maker of renderers that are released after the test."""
    made: list[Renderer] = []

    def make(world: Scene, **settings: Any) -> Renderer:
        made.append(Renderer(device, world, SETTINGS.replace(settings), SIZE))
        return made[-1]

    yield make
    for renderer in made:
        renderer.release()


@pytest.fixture
def on_device(device: Device) -> Iterator[Any]:
    """Maker of GPU scenes that are released after the test."""
    made: list[GpuScene] = []

    def make(world: Scene) -> GpuScene:
        made.append(GpuScene(device, world))
        return made[-1]

    yield make
    for gpu in made:
        gpu.release()


def picture(renderer: Renderer, time_s: float, view: str = "scene_color") -> Array:
    """Of the second frame at a time: the octree's pools grow with the frame after a full one."""
    renderer.render(EYE, time_s, 0, view)
    renderer.device.finish()
    return renderer.read(renderer.render(EYE, time_s, 1, view))


def pose_of(**fields: Any) -> Pose:
    none = {"instances": np.zeros(0, np.int64), "world_from_local": np.zeros((0, 4, 4), np.float32),
            "visible": np.zeros(0, np.bool_), "joints": {}, "weights": {}, "lights": [],
            "cameras": []}  # fmt: skip
    return Pose(**(none | fields))


def test_a_moving_scene_looks_like_a_still_one_posed_alike(renderers: Any) -> None:
    """With lights, shadows, area lights and voxels, whatever came before. Bricks may stand
    elsewhere in the atlases, where coordinates round otherwise: few half floats differ by a step.
    """

    def assert_alike(one: Array, other: Array, note: str) -> None:
        np.testing.assert_allclose(one, other, rtol=2.0**-9, atol=2.0**-14, err_msg=note)
        assert (one != other).any(axis=2).mean() < 0.01, note

    world = stage()
    moving = renderers(world)
    pictures = []
    for t in (0.0, 0.4, 1.2, 1.9, 0.4):
        shown = picture(moving, t)
        still = posed(world, t)
        assert len(still.instances) == (4 if 1.0 <= t < 2.0 else 5)
        assert_alike(shown, picture(renderers(still), 0.0), str(t))
        pictures.append(shown)
    assert np.abs(pictures[1] - pictures[2])[..., :3].max() > 0.1
    assert_alike(pictures[1], pictures[4], "again")


def test_bent_meshes_are_numpy_s_to_rounding(device: Device, on_device: Any) -> None:
    world = bending_stage()
    gpu = on_device(world)
    for t in (0.3, 1.6):
        pose = evaluate(world, t)
        gpu.update(pose)
        g = device.begin_frame()
        gpu.deform(g)
        g.execute()
        positions = gpu.positions.read(np.float32).reshape(-1, 3)
        surface = gpu._surface.read(SURFACE_VERTEX)
        for number in (1, 2, 3, 4):
            shape = world.meshes[world.instances[number].mesh]
            want = deformed(shape, pose.joints.get(number), pose.weights.get(number))
            first = int(gpu._geometry.placed_vertex[number])
            rows = slice(first, first + len(shape.positions))
            np.testing.assert_allclose(positions[rows], want.positions, atol=2e-6)
            np.testing.assert_allclose(surface["a_normal"][rows], want.normals, atol=5e-6)
            np.testing.assert_allclose(surface["a_tangent"][rows], want.tangents, atol=5e-6)
            np.testing.assert_array_equal(surface["a_uv0"][rows], shape.uv0)
            np.testing.assert_array_equal(surface["a_color"][rows], shape.colors)
        at_rest = gpu._geometry.first_vertex[world.instances[1].mesh]
        shape = world.meshes[world.instances[1].mesh]
        np.testing.assert_array_equal(
            positions[at_rest : at_rest + len(shape.positions)], shape.positions
        )


def test_bent_meshes_look_like_still_ones(renderers: Any) -> None:
    world = bending_stage()
    world.lights = [sun(vector(0.3, -1, -0.4), 3.0)]
    moving = renderers(world)
    picture(moving, 0.0)
    shown = picture(moving, 1.3)
    fresh = picture(renderers(world), 1.3)  # with no past: its bricks stand elsewhere
    np.testing.assert_allclose(shown, fresh, rtol=2.0**-9, atol=1e-4)
    assert (shown != fresh).mean() < 0.01
    still = picture(renderers(posed(world, 1.3)), 0.0)
    differ = np.abs(shown - still)[..., :3].max(axis=2) > 0.02
    assert differ.mean() < 0.01  # rounding moves edges and voxels
    assert np.abs(picture(moving, 0.0) - shown).max() > 0.2


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


def test_changes_tell_where_things_were_and_are(on_device: Any) -> None:
    world = stage()
    gpu = on_device(world)
    assert gpu.dynamic.tolist() == [False, False, True, True, True]
    gpu.update(evaluate(world, 0.0))
    assert (gpu.changes, gpu.version) == ([], 0)
    gpu.update(evaluate(world, 0.5))
    assert gpu.version == 1
    ball, sheet, cube = gpu.changes
    assert (ball.instance, sheet.instance, cube.instance) == (2, 3, 4)
    assert ball.moved
    for bounds, y in ((sheet.before, 2.5), (sheet.after, 2.0)):
        assert bounds is not None
        np.testing.assert_allclose(bounds, [[1.1, y, -0.4], [1.9, y, 0.4]], atol=1e-6)
    gpu.update(evaluate(world, 1.5))
    hidden = gpu.changes[2]
    assert hidden.before is not None
    assert hidden.after is None
    gpu.update(evaluate(world, 1.5))
    assert (gpu.changes, gpu.version) == ([], 2)
    gpu.update(evaluate(world, 2.0))
    shown = gpu.changes[2]
    assert (shown.before, shown.instance) == (None, 4)
    gpu.update(None)
    assert gpu.changes == []


def rows(gpu: GpuScene) -> Array:
    return gpu.instances.read(gpu._table.rows.dtype)


def test_rows_hold_this_frame_s_and_the_last_frame_s_transforms(on_device: Any) -> None:
    world = stage()
    gpu = on_device(world)
    before = rows(gpu)
    for t, t_before in ((0.25, 0.25), (0.5, 0.25), (0.5, 0.5), (1.5, 0.5)):
        gpu.update(evaluate(world, t))
        got, now, last = rows(gpu), evaluate(world, t), evaluate(world, t_before)
        np.testing.assert_array_equal(got[:2], before[:2])
        for number in (2, 3):
            k = number - 2
            matrix = got["world_from_local"][number].T
            np.testing.assert_array_equal(matrix, now.world_from_local[k])
            previous = got["prev_world_from_local"][number].T
            np.testing.assert_array_equal(previous, last.world_from_local[k])
    assert not rows(gpu)["world_from_local"][4].any()  # hidden
    gpu.update(evaluate(world, 2.0))
    np.testing.assert_array_equal(
        rows(gpu)["prev_world_from_local"][4], rows(gpu)["world_from_local"][4]
    )


def test_only_what_changed_is_uploaded(on_device: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    world = scene(*[(mesh(box()), at(3 * n, 0, 0)) for n in range(10)])
    for instance in world.instances[4:]:
        instance.dynamic = True
    gpu = on_device(world)
    numbers = np.arange(4, 10)
    worlds = np.array([at(3 * n, 0, 0) for n in numbers])
    written: list[tuple[int, int]] = []
    monkeypatch.setattr(
        Buffer, "write", lambda self, values, offset=0: written.append((len(values), offset))
    )

    def update() -> list[tuple[int, int]]:
        written.clear()
        gpu.update(pose_of(instances=numbers, world_from_local=worlds, visible=np.ones(6, bool)))
        size = gpu._table.rows.itemsize
        return [(count, offset // size) for count, offset in written]

    assert update() == []
    worlds = worlds.copy()
    worlds[[1, 3], 1, 3] = 1.0
    assert update() == [(3, 5)]
    assert [change.instance for change in gpu.changes] == [5, 7]
    assert update() == [(3, 5)]  # they come to rest
    assert gpu.changes == []
    assert update() == []


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


def test_static_and_dynamic_instances_can_be_drawn_apart(on_device: Any) -> None:
    world = stage()
    gpu = on_device(world)
    modes = ("opaque", "mask", "blend")
    apart = {flag: gpu.batches(modes, dynamic=flag) for flag in (False, True)}
    for flag, batches in apart.items():
        drawn = [gpu._order[k] for batch in batches for k in gpu._culling.instances_of(batch)]
        assert sorted(drawn) == np.flatnonzero(gpu.dynamic == flag).tolist()
    assert gpu.batches(modes) == [*apart[False], *apart[True]]


def test_a_new_material_is_the_scene_s_and_changes_its_users(renderers: Any) -> None:
    """Emission and colour, a lamp that goes dark, and other draw state: the same as made anew."""
    world = stage()
    renderer = renderers(world)
    before = picture(renderer, 0.5)
    for index, new in (
        (2, colored(0.9, 0.1, 0.1)),
        (2, glowing(0, 3, 0)),
        (2, glowing(0, 30, 0)),  # brighter than what the voxels were made for
        (3, material(base_color=vector(3, 2, 1, 1), unlit=True)),  # was an area light
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
