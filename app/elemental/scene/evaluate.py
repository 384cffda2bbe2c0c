"""The pose of a scene at a time: pure numpy, float64 inside, no state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from elemental.scene.lights import same_objects
from elemental.scene.model import Camera, Light, Scene
from elemental.scene.motion import F32, F64, Indices, Motion, Tracks
from elemental.scene.placement import forward, rigid, singular

PARALLEL_COSINE = 1.0 - 1e-9
"""Quaternions with a larger dot product are interpolated along the chord, which is as exact."""

SHORTEST_QUATERNION = 1e-9
"""Of keys of length 1: what is shorter is rounding."""


@dataclass(frozen=True)
class Pose:
    """Where everything that can move is.

    instances (D,): numbers of the dynamic instances, ascending; world_from_local (D, 4, 4) float32;
    visible (D,) bool, false where hidden or scaled to nothing; joints: by instance number the
    (J, 4, 4) float32 world from mesh space of a skinned one's joints; weights: by instance number
    the (T,) float32 of a morphed one; lights and cameras: all of the scene's.
    """

    instances: Indices
    world_from_local: F32
    visible: npt.NDArray[np.bool_]
    joints: Mapping[int, F32]
    weights: Mapping[int, F32]
    lights: list[Light]
    cameras: list[Camera]


def dynamic_instances(scene: Scene) -> list[int]:
    """Their numbers, ascending."""
    return [n for n, instance in enumerate(scene.instances) if instance.dynamic]


def evaluate(scene: Scene, time_s: float, dynamic: Sequence[int] | None = None) -> Pose:
    """The scene's pose at `time_s` seconds. Time before 0 counts as 0 for what does not loop.

    `dynamic`: the `dynamic_instances`, where the caller knows them.
    """
    numbers = dynamic_instances(scene) if dynamic is None else dynamic
    moving = [scene.instances[n] for n in numbers]
    worlds = np.array([i.world_from_local for i in moving], np.float32).reshape(-1, 4, 4)
    visible = np.ones(len(numbers), np.bool_)
    motion = scene.motion
    if motion is None:
        weights = {n: i.weights for n, i in zip(numbers, moving, strict=True)
                   if i.weights is not None}  # fmt: skip
        indices = np.array(numbers, np.int64)
        return Pose(indices, worlds, visible, {}, weights, scene.lights, scene.cameras)
    nodes = _nodes(motion, time_s)
    world = nodes.world
    node_of = np.array([i.node for i in moving], np.int64)
    skinned = np.array([i.skin >= 0 for i in moving], np.bool_)
    placed = np.flatnonzero((node_of >= 0) & ~skinned)
    worlds[placed] = world[node_of[placed]]
    visible[placed] = nodes.visible[node_of[placed]] & ~singular(world[node_of[placed]])
    joints: dict[int, F32] = {}
    matrices = [world[s.joints] @ s.inverse_bind for s in motion.skins]
    for k in np.flatnonzero(skinned).tolist():
        held = matrices[moving[k].skin]
        joints[numbers[k]] = held.astype(np.float32)
        shown = moving[k].node < 0 or nodes.visible[moving[k].node]
        visible[k] = shown and not singular(held).all()
    weights = {}
    for number, instance in zip(numbers, moving, strict=True):
        if instance.weights is not None:
            found = nodes.weights.get(instance.node)
            weights[number] = instance.weights if found is None else found.astype(np.float32)
    lights = [_light_at(light, nodes) for light in scene.lights]
    cameras = [_camera_at(camera, nodes) for camera in scene.cameras]
    return Pose(
        np.array(numbers, np.int64), worlds, visible, joints, weights, lights, cameras
    )  # fmt: skip


class LastPose:
    """The pose of a scene that is asked for again and again while time stands still."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._dynamic = dynamic_instances(scene)
        self._time_s: float | None = None
        self._lights: list[Light] = []
        self._pose: Pose | None = None

    def at(self, time_s: float) -> Pose | None:
        """The scene's pose, the very object as before where time and the scene's lights are the
        same; None where nothing can move."""
        scene = self._scene
        if scene.motion is None:
            return None
        same = time_s == self._time_s and same_objects(self._lights, scene.lights)
        if self._pose is None or not same:
            self._time_s, self._lights = time_s, list(scene.lights)
            self._pose = evaluate(scene, time_s, self._dynamic)
        return self._pose


def placed_camera(scene: Scene, camera: Camera, time_s: float) -> Camera:
    """One of the scene's cameras, or one made of it, where it is at a time."""
    if scene.motion is None or camera.node < 0:
        return camera
    return _camera_at(camera, _nodes(scene.motion, time_s))


@dataclass(frozen=True)
class _Nodes:
    """world (N, 4, 4) float64, visible (N,) bool, weights (T,) float64 by node."""

    world: F64
    visible: npt.NDArray[np.bool_]
    weights: Mapping[int, F64]


def _nodes(motion: Motion, time_s: float) -> _Nodes:
    rig = motion.rig
    at_rest = {"translation": rig.translations, "rotation": rig.rotations, "scale": rig.scales}
    parts = {path: values.copy() for path, values in at_rest.items()}
    parts["visible"] = np.ones((len(rig), 1))
    weights: dict[int, F64] = {}
    for tracks in motion.tracks:
        values = sample(tracks, time_s)
        if tracks.path == "weights":
            weights |= dict(zip(tracks.nodes.tolist(), values, strict=True))
        else:
            parts[tracks.path][tracks.nodes] = values
    local = rig.offsets @ composed(parts["translation"], parts["rotation"], parts["scale"])
    world, visible = local, parts["visible"][:, 0] >= 0.5
    for level in rig.levels[1:]:
        parents = rig.parents[level]
        world[level] = world[parents] @ local[level]
        visible[level] &= visible[parents]
    return _Nodes(world, visible, weights)


def composed(translations: F64, quaternions: F64, scales: F64) -> F64:
    """(N, 4, 4) float64 T @ R @ S of (N, 3), (N, 4) of any length but 0, and (N, 3)."""
    x, y, z, w = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    matrices = np.zeros((len(scales), 4, 4))
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    for r, row in enumerate(rows):
        for c, column in enumerate(row):
            matrices[:, r, c] = column * scales[:, c]
    matrices[:, :3, 3] = translations
    matrices[:, 3, 3] = 1.0
    return matrices


def sample(tracks: Tracks, time_s: float) -> F64:
    """(n, W) values of the tracks at a time [glTF 2.0, appendix C]."""
    times = tracks.times
    cubic = tracks.interpolation == "cubic"
    t = time_s % tracks.length_s if tracks.loop and tracks.length_s > 0.0 else time_s
    keys = tracks.values[:, :, 1] if cubic else tracks.values
    k = int(np.searchsorted(times, t, side="right")) - 1
    if k < 0 or k == len(times) - 1 or tracks.interpolation == "step":
        value: F64 = keys[:, max(k, 0)]
        return value
    width = times[k + 1] - times[k]
    s = (t - times[k]) / width
    if cubic:
        leaving, arriving = tracks.values[:, k, 2] * width, tracks.values[:, k + 1, 0] * width
        value = _hermite(keys[:, k], leaving, keys[:, k + 1], arriving, s)
        if tracks.path == "rotation":
            value = _turning(value, keys[:, k] if s < 0.5 else keys[:, k + 1])
    elif tracks.path == "rotation":
        value = slerp(keys[:, k], keys[:, k + 1], s)
    else:
        value = (1.0 - s) * keys[:, k] + s * keys[:, k + 1]
    return value


def slerp(a: F64, b: F64, s: float) -> F64:
    """(n, 4) unit quaternions on the shorter arcs from a to b, (n, 4) unit each, at s in 0..1."""
    cosine = (a * b).sum(axis=1, keepdims=True)
    b = np.where(cosine < 0.0, -b, b)
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    near = np.abs(cosine) > PARALLEL_COSINE
    sine = np.where(near, 1.0, np.sin(angle))
    lead = np.where(near, 1.0 - s, np.sin((1.0 - s) * angle) / sine)
    follow = np.where(near, s, np.sin(s * angle) / sine)
    mixed = lead * a + follow * b
    unit: F64 = mixed / np.linalg.norm(mixed, axis=1, keepdims=True)
    return unit


def _hermite(p0: F64, m0: F64, p1: F64, m1: F64, s: float) -> F64:
    """Cubic Hermite curve; the tangents m0 and m1 are over the whole interval."""
    point: F64 = (
        (2.0 * s**3 - 3.0 * s**2 + 1.0) * p0
        + (s**3 - 2.0 * s**2 + s) * m0
        + (3.0 * s**2 - 2.0 * s**3) * p1
        + (s**3 - s**2) * m1
    )
    return point


def _turning(quaternions: F64, nearer: F64) -> F64:
    """(n, 4), where they have a direction; where a curve passes through 0, the nearer key's."""
    length = np.linalg.norm(quaternions, axis=1, keepdims=True)
    return np.where(length > SHORTEST_QUATERNION, quaternions, nearer)


def _light_at(light: Light, nodes: _Nodes) -> Light:
    if light.node < 0:
        return light
    world = nodes.world[light.node]
    shown = light.intensity if nodes.visible[light.node] else 0.0
    position = world[:3, 3].astype(np.float32)
    return replace(light, position=position, direction=forward(world), intensity=shown)


def _camera_at(camera: Camera, nodes: _Nodes) -> Camera:
    if camera.node < 0:
        return camera
    return replace(camera, world_from_view=rigid(nodes.world[camera.node]))
