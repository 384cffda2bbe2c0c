"""Draws that leave out what is not seen: never anything that is. SH-01"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from elemental.gpu.device import Device
from elemental.gpu.formats import R32F
from elemental.gpu.graph import Graph
from elemental.passes import depth_pyramid, view_draws
from elemental.passes.camera_view import pack_view
from elemental.passes.culling import in_frustum
from elemental.passes.gbuffer import draw_gbuffer
from elemental.passes.scene_gpu import GpuScene
from elemental.scene.evaluate import evaluate
from elemental.scene.model import Camera, Instance, Scene, Texture, TextureSlot
from glsl.harness import run_glsl
from gpu.moving import bending_stage, pose_of
from gpu.rig import IDENTITY, at, camera, material, mesh, scene, vector
from shapes import box, quad, sphere

Array = np.ndarray[Any, Any]
SIZE = (75, 41)  # no power of two, and no multiple of a tile
TARGETS = ("depth", "scene_color", "a", "b", "c", "d")
STATIC, MOVERS = 80, 10
LOOKING = ("cull", "depth.", "gbuffer.depth")
"""What the names of the passes begin with that find out what is seen."""


@pytest.fixture(autouse=True)
def small_scenes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(view_draws, "OCCLUSION_FROM", 0)


@pytest.fixture
def world() -> Scene:
    """Walls that hide others, things of all materials behind and before them, movers among them.

    Four panes of two materials lie in one plane, so that what is equally near is in the picture.
    """
    rng = np.random.default_rng(4)
    holes = np.full((2, 2, 4), 255, np.uint8)
    holes[0, 0, 3] = 0
    materials = [
        material(base_color=vector(0.8, 0.2, 0.1, 1)),
        material(base_color=vector(0.1, 0.4, 0.9, 1), double_sided=True),
        material(alpha_mode="mask", base_color_texture=TextureSlot(0)),
    ]
    panes = [mesh(quad(2.0), n) for n in range(2)]
    for pane in panes:
        pane.colors = rng.integers(0, 256, pane.colors.shape).astype(np.uint8)
    ball = sphere(0.5)
    meshes = [mesh(box((0.2, 3, 7))), mesh(ball, 0, smooth=True), mesh(ball, 1, smooth=True),
              mesh(box((0.4, 0.4, 0.4)), 2), *panes]  # fmt: skip
    made = scene(materials=materials, textures=[Texture("holes", holes, nearest=True)])
    made.meshes = meshes
    places = [(0, at(x, 0, 0)) for x in (-3, 0, 3)]
    places += [(4 + n % 2, at(0.3 * n - 2, 0.5, 0.3 * n)) for n in range(4)]
    for _ in range(STATIC):
        scale = np.diag([*rng.uniform(0.4, 1.2, 3), 1.0]).astype(np.float32)
        places.append((int(rng.integers(1, 4)), at(*rng.uniform((-6, -1, -4), (6, 1, 4))) @ scale))
    made.instances = [Instance(str(n), m, matrix) for n, (m, matrix) in enumerate(places)]
    made.instances += [Instance(f"m{n}", n % 4, IDENTITY, dynamic=True) for n in range(MOVERS)]
    made.extent = (np.full(3, -8, np.float32), np.full(3, 8, np.float32))
    return made


@pytest.fixture
def pair(device: Device, world: Scene) -> Iterator[list[GpuScene]]:
    """The world twice: with culling and without."""
    made = [GpuScene(device, replace(world, materials=list(world.materials))) for _ in range(2)]
    yield made
    for gpu in made:
        gpu.release()


def targets(
    device: Device,
    gpu: GpuScene,
    seen_from: Camera,
    culling: str,
    size: tuple[int, int] = SIZE,
) -> list[Array]:
    """The G-buffer of a frame."""
    g = device.begin_frame()
    gpu.deform(g)
    gb = draw_gbuffer(g, pack_view(seen_from, size, gpu.bounds), gpu, size, culling)
    handles = [getattr(gb, name) for name in TARGETS]
    for handle in handles:
        g.keep(handle)
    g.execute()
    return [handle.physical.read() for handle in handles]


def walk(frame: int) -> Camera:
    """Along the walls, about them, and at times elsewhere at once."""
    if frame % 7 == 6:
        return camera(vector(0.2, 6, 0.1), vector(0, 0, 0))
    angle = 0.37 * frame
    eye = vector(5.5 * np.cos(angle), 0.3, 2.5 * np.sin(angle))
    return camera(eye, vector(0, 0, 0), fov_y=1.1)


def moved(world: Scene, frame: int) -> Any:
    """Movers cross the walls; some are hidden for a while."""
    rng = np.random.default_rng(1)
    swing, center = rng.uniform(-3, 3, (2, MOVERS, 3))
    places = swing * np.cos(0.3 * frame) + center
    numbers = np.arange(len(world.instances) - MOVERS, len(world.instances))
    matrices = np.array([at(*place) for place in places])
    visible = (numbers + frame) % 5 != 0
    return pose_of(instances=numbers, world_from_local=matrices, visible=visible)


@pytest.mark.parametrize("culling", ["frustum", "occlusion"])
def test_pictures_are_those_without_culling(
    device: Device, world: Scene, pair: list[GpuScene], culling: str
) -> None:
    """Every target to the bit, as the camera and things move, halt and jump, not all at once."""
    hidden = []
    for frame in range(24):
        eye = walk(min(frame, 5) if frame < 20 else frame)
        step = min(frame, 14)
        for gpu in pair:
            gpu.update(moved(world, step))
        got = targets(device, pair[0], eye, culling)
        want = targets(device, pair[1], eye, "none")
        for name, one, other in zip(TARGETS, got, want, strict=True):
            np.testing.assert_array_equal(one, other, err_msg=f"{name}, frame {frame}")
        device.finish()
        counts = pair[0].in_view.counters.counters()
        shown = len(world.instances) - counts["instances_outside"] - counts["instances_hidden"]
        assert shown == counts["instances_drawn"] > 0
        hidden.append(counts["instances_hidden"])
    assert (max(hidden) > 20) is (culling == "occlusion")


def test_what_bends_is_never_left_out(device: Device) -> None:
    """Skinned and morphed bodies by their boxes of the frame."""
    world = bending_stage()
    front = [Instance("wall", len(world.meshes), at(0, 0.8, z)) for z in (1.2, 1.4)]
    world.meshes = [*world.meshes, mesh(box((2.0, 1.5, 0.05)))]
    world.instances = [*front, *world.instances]
    world.extent = (np.full(3, -8, np.float32), np.full(3, 8, np.float32))
    made = [GpuScene(device, world) for _ in range(2)]
    for frame in range(10):
        view = camera(vector(0.3 * frame - 1.5, 1, 5), vector(0, 0.7, 0))
        pictures = []
        for gpu, culling in zip(made, ("occlusion", "none"), strict=True):
            gpu.update(evaluate(world, 0.2 * frame))
            pictures.append(targets(device, gpu, view, culling))
        for one, other in zip(*pictures, strict=True):
            np.testing.assert_array_equal(one, other)
    for gpu in made:
        gpu.release()


def test_a_still_view_is_not_looked_at_again(device: Device, pair: list[GpuScene]) -> None:
    """Two frames settle what a view shows; from then on its draws alone are left."""
    ran = []
    for frame in range(5):
        targets(device, pair[0], walk(0 if frame < 4 else 1), "occlusion")
        device.finish()
        ran.append(sum(t.name.startswith(LOOKING) for t in device.timings))
    assert ran == [5, 5, 0, 0, 5]


def test_a_view_that_rested_shows_what_changes(
    device: Device, world: Scene, pair: list[GpuScene]
) -> None:
    """Another way to cull or material, each once the draws had settled: to the bit."""
    holed = replace(world.materials[0], alpha_mode="mask", base_color_texture=TextureSlot(0))
    steps = [(0, "occlusion"), (0, "frustum"), (3, "none"), (3, "occlusion"), (3, "occlusion")]
    pictures = []
    for number, (place, culling) in enumerate(steps):
        for gpu in pair:
            if number == len(steps) - 1:
                gpu.set_material(0, holed)
            gpu.update(moved(world, 0))
        for _ in range(3):
            want = targets(device, pair[1], walk(place), "none")
            got = targets(device, pair[0], walk(place), culling)
            for name, one, other in zip(TARGETS, got, want, strict=True):
                np.testing.assert_array_equal(one, other, err_msg=f"{name}, step {number}")
        device.finish()
        assert not any(t.name.startswith(LOOKING) for t in device.timings)
        pictures.append(want[TARGETS.index("depth")])
    assert (pictures[-1] != pictures[-2]).mean() > 0.05  # the walls' holes are seen


def test_more_pixels_show_what_was_between_fewer(device: Device) -> None:
    """A ball behind a slit, which at first no pixel's centre meets."""
    slabs = [(mesh(box((5.0, 6, 0.1))), at(x, 0, 0)) for x in (-2.6, 2.6)]
    gpu = GpuScene(device, scene(*slabs, (mesh(sphere(0.5), smooth=True), at(0, 0, -2))))
    eye = camera(vector(0, 0, 5), vector(0, 0, 0), fov_y=1.1)
    few, many = (20, 12), (160, 96)  # of one shape, so that the matrix is the same
    hidden = []
    for size in (few, few, few, many):
        depth = targets(device, gpu, eye, "occlusion", size)[0]
        device.finish()
        hidden.append(gpu.in_view.counters.counters()["instances_hidden"])
    assert hidden == [0, 1, 1, 0]
    np.testing.assert_array_equal(depth, targets(device, gpu, eye, "none", many)[0])
    gpu.release()


def test_frames_that_did_not_run_settle_nothing(
    device: Device, pair: list[GpuScene], monkeypatch: pytest.MonkeyPatch
) -> None:
    """One is given up before it is executed, one fails while it is."""

    def fail(_: Graph) -> None:
        raise RuntimeError("lost")

    for _ in range(3):
        targets(device, pair[0], walk(6), "occlusion")
    lost = [device.begin_frame() for _ in range(2)]
    for g in lost:
        view = pack_view(walk(0), SIZE, pair[0].bounds)
        g.keep(draw_gbuffer(g, view, pair[0], SIZE, "occlusion").a)
    with monkeypatch.context() as patched:
        patched.setattr(device.executor, "run", fail)
        with pytest.raises(RuntimeError, match="lost"):
            lost[1].execute()
    for _ in range(4):
        got = targets(device, pair[0], walk(0), "occlusion")
        for one, other in zip(got, targets(device, pair[1], walk(0), "none"), strict=True):
            np.testing.assert_array_equal(one, other)


def test_without_culling_nothing_is_counted(device: Device, pair: list[GpuScene]) -> None:
    """Not even what a frame before counts, which comes late."""
    for culling in ("occlusion", "none", "frustum"):
        targets(device, pair[0], walk(0), culling)
        if culling != "occlusion":
            device.finish()
            counts = pair[0].in_view.counters.counters()
            assert any(counts.values()) is (culling != "none")


def test_boxes_are_in_the_frustum_as_numpy_says(device: Device) -> None:
    rng = np.random.default_rng(3)
    low = rng.uniform(-8, 8, (500, 3)).astype(np.float32)
    high = low + rng.uniform(0, 2, (500, 3)).astype(np.float32)
    block = pack_view(walk(1), SIZE, (low.min(0), high.max(0)))
    inputs = {"low": low, "high": high}
    got = run_glsl(device, ["lib/occlusion.glsl"], "uint(is_in_frustum(low, high))", inputs,
                   "uint", params={"View": block})  # fmt: skip
    want = in_frustum(np.asarray(block["clip_from_world"]).T, low, high)
    assert 50 < want.sum() < 450
    np.testing.assert_array_equal(got.astype(bool), want)


def test_footprints_hold_every_point_of_their_box(device: Device) -> None:
    """Points in boxes far from the origin: inside the pixels, behind the nearest depth."""
    rng = np.random.default_rng(5)
    far_off = np.array([900.0, 0.0, -400.0])
    view = walk(1)
    eye = view.world_from_view.copy()
    eye[:3, 3] += far_off.astype(np.float32)
    low = (rng.uniform(-6, 6, (300, 3)) + far_off).astype(np.float32)
    high = low + rng.uniform(0, 1, (300, 3)).astype(np.float32)
    block = pack_view(replace(view, world_from_view=eye), SIZE, (low.min(0), high.max(0)))
    function = """
    vec4 rect(vec3 low, vec3 high) {
        Footprint f;
        return find_footprint(low, high, f) ? vec4(f.from, f.to) : vec4(0, 0, 1e6, 1e6);
    }
    float nearest(vec3 low, vec3 high) {
        Footprint f;
        return find_footprint(low, high, f) ? f.nearest : -1.0;
    }"""
    inputs = {"low": low, "high": high}
    rect, nearest = (
        run_glsl(device, ["lib/occlusion.glsl"], f"{name}(low, high)", inputs, kind,
                 functions=function, params={"View": block})
        for name, kind in (("rect", "vec4"), ("nearest", "float"))
    )  # fmt: skip
    clip = np.asarray(block["clip_from_world"], np.float64).T
    for share in rng.random((20, 3)):
        points = np.append(low + share * (high.astype(np.float64) - low), np.ones((300, 1)), 1)
        p = points @ clip.T
        p = p[:, :3] / p[:, 3:]
        inside = (np.abs(p) < 1).all(axis=1)
        px = np.floor((p[:, :2] * 0.5 + 0.5) * SIZE)
        assert inside.sum() > 30
        assert ((px >= rect[:, :2]) & (px <= rect[:, 2:]))[inside].all()
        assert (p[inside, 2] * 0.5 + 0.5 > nearest[inside]).all()


@pytest.mark.parametrize("size", [(1, 1), (75, 41), (300, 17), (640, 360)])
def test_the_pyramid_holds_the_farthest_depths(device: Device, size: tuple[int, int]) -> None:
    rng = np.random.default_rng(8)
    depth = rng.random(size[::-1], np.float32)
    g = device.begin_frame()
    source = device.texture("depths", size, R32F, data=depth)
    pyramid = depth_pyramid.depth_pyramid(g, source)
    g.keep(pyramid)
    g.execute()
    assert pyramid.physical is not None
    for level in range(depth_pyramid.LEVELS):
        side = 2 << level
        padded = np.zeros([-(-n // side) * side for n in depth.shape], np.float32)
        padded[: size[1], : size[0]] = depth
        rows, columns = padded.shape[0] // side, padded.shape[1] // side
        want = padded.reshape(rows, side, columns, side).max(axis=(1, 3))
        got = pyramid.physical.read(level)[:rows, :columns]
        np.testing.assert_array_equal(got.reshape(want.shape), want)
    source.release()
