"""The box that a moving scene never leaves, found by looking at many moments of it."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from elemental.core.errors import InputError
from elemental.scene.boxes import Box, MeshBoxes
from elemental.scene.deform import turns_over, use_mirrored
from elemental.scene.evaluate import Pose, evaluate
from elemental.scene.model import Instance, Scene
from elemental.scene.motion import Motion
from elemental.scene.placement import mirrors

SAMPLES = 256
"""Moments of one set of keys that are looked at [inferred: a turn seen 48 times stays within 0.2 %
of its radius]."""
MOST_BETWEEN_KEYS = 16
PHASE_SAMPLES = 128
"""Further moments where loops of different lengths shift against each other."""
LOOPS = 97.0
"""Over how many of the longest loop those lie."""
GOLDEN = 0.6180339887498949
MOST_SAMPLES = 512
GROWTH = 1.0 / 128.0
"""Of the diagonal of what a moving thing reaches, for what lies between the moments."""


def settle(scene: Scene) -> None:
    """Bring a scene whose motion was just read to time 0 and give it its extent.

    What never moves comes first in `scene.instances`; what moves but is never seen is left out;
    what is mirrored where it is first seen gets the mesh for that. Raises InputError for a light or
    a camera whose motion overflows.
    """
    if scene.motion is None:
        return
    scene.instances.sort(key=lambda instance: instance.dynamic)  # stable
    with np.errstate(over="ignore", invalid="ignore"):
        poses = [evaluate(scene, t) for t in sample_times(scene.motion)]
        first = poses[0]
        boxes: list[Box] = []
        for instance in scene.instances:
            if not instance.dynamic:
                low, high = scene.instance_bounds(instance)
                boxes.append((low.astype(np.float64), high.astype(np.float64)))
        unseen: list[Instance] = []
        for k, number in enumerate(first.instances.tolist()):
            instance = scene.instances[number]
            seen = [pose for pose in poses if pose.visible[k]]
            if seen:
                boxes.append(_swept(scene, instance, number, k, seen))
                _start(scene, instance, number, k, seen)
            else:
                unseen.append(instance)
        scene.instances = [i for i in scene.instances if not any(i is u for u in unseen)]
        if boxes:
            lows, highs = zip(*boxes, strict=True)
            low, high = np.min(lows, axis=0), np.max(highs, axis=0)
            scene.extent = low.astype(np.float32), high.astype(np.float32)
    if unseen:
        scene.hidden += len(unseen)
        scene.notes.append(f"{scene.path}: {len(unseen)} meshes are left out, which never show")
    for pose in poses:
        _check_finite(scene, pose)
    scene.lights = [
        replace(now, intensity=light.intensity)
        for light, now in zip(scene.lights, first.lights, strict=True)
    ]
    scene.cameras = first.cameras


def _check_finite(scene: Scene, pose: Pose) -> None:
    """Of lights and cameras; what meshes reach is checked with the extent."""
    placed = [(light.name, light.position) for light in pose.lights]
    placed += [(camera.name, camera.world_from_view) for camera in pose.cameras]
    for name, numbers in placed:
        if not np.isfinite(numbers).all():
            raise InputError(scene.path, name, "its motion leaves the range of 32-bit floats")


def _start(scene: Scene, instance: Instance, number: int, k: int, seen: list[Pose]) -> None:
    """Place an instance as in the first moment that shows it, mirrored if it is so there."""
    instance.world_from_local = seen[0].world_from_local[k]
    if number in seen[0].joints:
        sides = [turns_over(pose.joints[number]) for pose in seen]
    else:
        sides = mirrors(np.array([pose.world_from_local[k] for pose in seen])).tolist()
    if sides[0]:
        use_mirrored(scene, instance)
    if len(set(sides)) > 1:
        reason = "is mirrored for a part of its motion, where its back faces show"
        scene.warnings.append(str(InputError(scene.path, instance.name, reason)))


def _swept(scene: Scene, instance: Instance, number: int, k: int, seen: list[Pose]) -> Box:
    worlds = np.array([pose.world_from_local[k] for pose in seen])
    joints = np.array([p.joints[number] for p in seen]) if number in seen[0].joints else None
    weights = np.array([p.weights[number] for p in seen]) if number in seen[0].weights else None
    low, high = MeshBoxes(scene.meshes[instance.mesh]).around(worlds, joints, weights)
    margin = GROWTH * np.linalg.norm(high - low)
    return low - margin, high + margin


def sample_times(motion: Motion) -> list[float]:
    """Moments that show all of a motion, 0 first: its keys, moments between them, and phases."""
    chosen: set[float] = {0.0}
    keys = {(t.length_s, t.times.tobytes()): t.times for t in motion.tracks}
    for (length_s, _), times in keys.items():
        steps = int(np.clip(SAMPLES // len(times), 1, MOST_BETWEEN_KEYS))
        found = [float(times[0])]
        for a, b in pairwise(times):
            found += [float(a + (b - a) * (k + 1) / steps) for k in range(steps)]
        last = float(np.nextafter(length_s, 0.0))  # the end itself is the next loop's beginning
        chosen |= {min(found[k], last) for k in _spread(len(found), SAMPLES)}
    lengths = {t.length_s for t in motion.tracks}
    if len(lengths) > 1:
        span = LOOPS * max(lengths)
        chosen |= {span * ((k * GOLDEN) % 1.0) for k in range(PHASE_SAMPLES)}
    moments = sorted(chosen)
    return [moments[k] for k in _spread(len(moments), MOST_SAMPLES)]


def _spread(count: int, most: int) -> list[int]:
    """Indices below `count`, evenly spread, the first and the last among them."""
    indices: list[int] = np.linspace(0, count - 1, min(count, most)).astype(int).tolist()
    return indices
