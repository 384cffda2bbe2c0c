"""Small scenes that move, and pictures of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.frame import Renderer
from elemental.scene.evaluate import Pose
from elemental.scene.extent import settle
from elemental.scene.model import Mesh, Scene
from elemental.scene.motion import Influences, Morphs, RigBuilder, Skin, Tracks
from elemental.settings import Settings
from gpu.rig import IDENTITY, at, camera, mesh, scene, sun, vector
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
