"""The motions of a scene file as nodes and tracks of a rig."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path as File

import numpy as np

from elemental.core.errors import InputError
from elemental.scene.camera_path import slope_at
from elemental.scene.model import FloatArray
from elemental.scene.motion import F64, Path, RigBuilder, Tracks
from elemental.scene.tables.motions import MotionKeyTable, MotionTable, TurnTable

TURN_KEYS = 4
"""Keys of a whole turn, a third apart: slerp between them is even and unambiguous."""


class Movers:
    """The nodes that a scene file's motions give its models and lights."""

    def __init__(self, builder: RigBuilder, motions: Sequence[MotionTable], path: File) -> None:
        """Raises InputError for a thing that is moved twice."""
        self._builder, self._path = builder, path
        self._motions: dict[tuple[str, str], tuple[int, MotionTable]] = {}
        self._found: set[tuple[str, str]] = set()
        for number, table in enumerate(motions):
            kind = "model" if table.model is not None else "light"
            key = kind, table.model or table.light or ""
            if key in self._motions:
                reason = f"{key[1]!r} already has a motion"
                raise InputError(path, f"motions[{number}].{kind}", reason)
            self._motions[key] = number, table

    def node_at(self, kind: str, name: str, position: FloatArray) -> int:
        """The node at the `position` (3,) of a "model" or "light"; -1 where no motion moves it.

        Raises InputError where two things of the kind have the name that a motion uses.
        """
        key = kind, name
        if key not in self._motions:
            return -1
        number, table = self._motions[key]
        if key in self._found:
            raise InputError(self._path, f"motions[{number}].{kind}", f"two are named {name!r}")
        self._found.add(key)
        return _nodes(self._builder, table, position.astype(np.float64))

    def check(self) -> None:
        """Raises InputError for a motion of something that does not exist."""
        for (kind, name), (number, _) in self._motions.items():
            if (kind, name) not in self._found:
                raise InputError(
                    self._path, f"motions[{number}].{kind}", f"no {kind} is named {name!r}"
                )


def described(table: MotionTable) -> str:
    """What a motion moves and how, in a few words: model "orb": orbit, spin."""
    kind = "model" if table.model is not None else "light"
    how = [name for name in ("keys", "orbit", "spin") if getattr(table, name) is not None]
    return f'{kind} "{table.model or table.light}": {", ".join(how)}'


def _nodes(builder: RigBuilder, table: MotionTable, place: F64) -> int:
    parent = -1
    if table.orbit is not None:
        center = np.array(table.orbit.center)
        parent = builder.node(translation=center)
        builder.tracks.append(_turn(parent, table.orbit))
        place = place - center
    node = builder.node(parent, translation=place)
    if table.keys is not None:
        builder.tracks += _key_tracks(node, table, table.keys, place)
    if table.spin is not None:
        node = builder.node(node)
        builder.tracks.append(_turn(node, table.spin))
    return node


def _turn(node: int, table: TurnTable) -> Tracks:
    """Even turning about an axis, counter-clockwise as seen from its tip."""
    axis = np.array(table.axis) / np.linalg.norm(table.axis)
    times = np.linspace(0.0, abs(table.period), TURN_KEYS)
    half = np.linspace(0.0, math.copysign(math.pi, table.period), TURN_KEYS)[:, None]
    turns = np.concatenate([np.sin(half) * axis, np.cos(half)], axis=1)
    return Tracks("rotation", np.array([node]), times, turns[None], "linear", abs(table.period))


def _key_tracks(
    node: int, table: MotionTable, keys: Sequence[MotionKeyTable], place: F64
) -> list[Tracks]:
    times = np.array([key.time for key in keys], np.float64)
    moved: dict[Path, F64] = {
        "translation": place + np.array([key.translation for key in keys]),
        "rotation": np.array([_quaternion(key.rotation_deg) for key in keys]),
        "scale": np.array([[key.scale] * 3 for key in keys]),
        "visible": np.array([[float(key.visible)] for key in keys]),
    }
    rest: dict[Path, F64] = {
        "translation": place,
        "rotation": np.array([0.0, 0.0, 0.0, 1.0]),
        "scale": np.ones(3),
        "visible": np.ones(1),
    }
    return [
        _keyed(path, node, times, values, table)
        for path, values in moved.items()
        if (values != rest[path]).any()
    ]


def _keyed(path: Path, node: int, times: F64, values: F64, table: MotionTable) -> Tracks:
    nodes, length_s = np.array([node]), float(times[-1])
    if path == "visible" or table.interpolation == "step":
        return Tracks(path, nodes, times, values[None], "step", length_s, table.loop)
    if path == "rotation" or table.interpolation == "linear":
        return Tracks(path, nodes, times, values[None], "linear", length_s, table.loop)
    closed = table.loop and bool((values[0] == values[-1]).all())
    slopes = np.stack([slope_at(times, values, k, closed) for k in range(len(times))])
    values = np.stack([slopes, values, slopes], axis=1)
    return Tracks(path, nodes, times, values[None], "cubic", length_s, table.loop)


def _quaternion(rotation_deg: Sequence[float]) -> F64:
    """x, y, z, w of rotations about x, then y, then z."""
    turned = np.array([0.0, 0.0, 0.0, 1.0])
    for axis, degrees in enumerate(rotation_deg):
        half = math.radians(degrees) / 2
        quaternion = np.array([0.0, 0.0, 0.0, math.cos(half)])
        quaternion[axis] = math.sin(half)
        turned = _product(quaternion, turned)
    return turned


def _product(a: F64, b: F64) -> F64:
    """The rotation b, then a."""
    u, v = a[:3], b[:3]
    return np.concatenate([a[3] * v + b[3] * u + np.cross(u, v), [a[3] * b[3] - u @ v]])
