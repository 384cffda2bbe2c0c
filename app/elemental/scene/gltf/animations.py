"""Animations: channels and samplers as key-framed tracks. [glTF 2.0, 3.11 and appendix C]"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from elemental.scene.gltf.accessors import Accessors
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import Field
from elemental.scene.motion import F64, Interpolation, Path, Tracks

EVERY = "all"
"""The word for playing each animation, instead of a name."""
POINTER = "pointer"
PATHS: dict[str, Path] = {
    "translation": "translation", "rotation": "rotation", "scale": "scale", "weights": "weights",
}  # fmt: skip
INTERPOLATIONS: dict[str, Interpolation] = {
    "STEP": "step", "LINEAR": "linear", "CUBICSPLINE": "cubic",
}  # fmt: skip
WIDTHS: dict[Path, int] = {"translation": 3, "rotation": 4, "scale": 3, "weights": 1}
VALUE = 1
"""Where a cubic key's value lies between its tangents."""


@dataclass(frozen=True)
class Channel:
    """One property of one node over time; values (K, W), or (K, 3, W) for "cubic"."""

    node: int
    path: Path
    times: F64
    values: F64
    interpolation: Interpolation

    @property
    def held(self) -> F64 | None:
        """(W,) the value that it never leaves, None where it moves."""
        cubic = self.interpolation == "cubic"
        values = self.values[:, VALUE] if cubic else self.values
        flat = not cubic or len(values) == 1 or not self.values[:, ::2].any()
        return values[0] if flat and (values == values[0]).all() else None


@dataclass(frozen=True)
class Clip:
    """One animation of the file; it starts over after its last key."""

    name: str
    channels: Sequence[Channel]

    @property
    def length_s(self) -> float:
        return max((float(channel.times[-1]) for channel in self.channels), default=0.0)


def read_animations(document: Document, accessors: Accessors) -> list[Clip]:
    """All animations of the file, checked."""
    nodes, meshes = document.root.elements("nodes"), document.root.elements("meshes")
    reader = _Reader(document, accessors, nodes, meshes)
    clips = []
    for number, field in enumerate(document.root.elements("animations")):
        clips.append(Clip(field.text_or("name", f"animation{number}"), reader.channels(field)))
    return clips


def chosen_clips(clips: Sequence[Clip], wanted: str) -> list[Clip]:
    """The clips that play: all, none, or those of one name, which may be none too."""
    return list(clips) if wanted == EVERY else [clip for clip in clips if clip.name == wanted]


def held_values(clips: Iterable[Clip]) -> dict[tuple[int, Path], F64]:
    """The values of what the clips hold still: exporters write tracks for all nodes alike."""
    held: dict[tuple[int, Path], F64] = {}
    moved: set[tuple[int, Path]] = set()
    for clip in clips:
        for channel in clip.channels:
            value, key = channel.held, (channel.node, channel.path)
            if value is None:
                moved.add(key)
            else:
                held[key] = value
    return {key: value for key, value in held.items() if key not in moved}


def tracks_of(
    clips: Iterable[Clip], held: Container[tuple[int, Path]], rig_of: Mapping[int, int]
) -> list[Tracks]:
    """The channels but the held ones, those of the same times together.

    rig_of: the rig's node of each node that the scene shows and that moves.
    """
    tracks = []
    for clip in clips:
        groups: dict[tuple[object, ...], list[Channel]] = defaultdict(list)
        for channel in clip.channels:
            if channel.node in rig_of and (channel.node, channel.path) not in held:
                shape = channel.values.shape[1:]
                key = (channel.path, channel.interpolation, channel.times.tobytes(), shape)
                groups[key].append(channel)
        tracks += [
            Tracks(
                group[0].path,
                np.array([rig_of[channel.node] for channel in group], np.int64),
                group[0].times,
                np.stack([channel.values for channel in group]),
                group[0].interpolation,
                clip.length_s,
            )
            for group in groups.values()
        ]
    return tracks


class _Reader:
    def __init__(
        self, document: Document, accessors: Accessors, nodes: list[Field], meshes: list[Field]
    ) -> None:
        self._document, self._accessors = document, accessors
        self._nodes, self._meshes = nodes, meshes

    def channels(self, field: Field) -> list[Channel]:
        samplers = list(field.need("samplers"))
        found: dict[tuple[int, Path], Channel] = {}
        for channel in field.need("channels"):
            target = channel.need("target")
            path_field = target.need("path")
            if path_field.text() == POINTER:
                self._document.report.warn(
                    "animations", "KHR_animation_pointer is not supported; what it moves stands"
                )
                continue
            if path_field.text() not in PATHS:
                raise path_field.error(f"expected one of {', '.join(PATHS)}")
            path = PATHS[path_field.text()]
            sampler = samplers[channel.need("sampler").index(len(samplers), "samplers")]
            node = target.index_or_none("node", len(self._nodes), "nodes")
            if node is None:
                continue  # to be ignored [glTF 2.0, 3.11]
            if (node, path) in found:
                raise target.error(f"the {path} of node {node} is moved twice in one animation")
            if path != "weights" and self._nodes[node].find("matrix") is not None:
                raise target.error(f"node {node} has a matrix, which can't be animated")
            found[node, path] = self._channel(sampler, target, node, path)
        return list(found.values())

    def _channel(self, sampler: Field, target: Field, node: int, path: Path) -> Channel:
        interpolation = sampler.choice_or("interpolation", INTERPOLATIONS["LINEAR"], INTERPOLATIONS)
        targets = self._target_count(target, node) if path == "weights" else 1
        times = self._times(sampler.need("input"))
        reference = sampler.need("output")
        raw = self._accessors.floats(reference, (WIDTHS[path],)).astype(np.float64)
        if not np.isfinite(raw).all():
            key = int(np.flatnonzero(~np.isfinite(raw).all(axis=1))[0])
            raise reference.error(f"value {key} is NaN or infinite")
        a_key = (3 if interpolation == "cubic" else 1) * targets
        if len(raw) != len(times) * a_key:
            raise reference.error(
                f"has {len(raw)} values, {len(times)} keys of {a_key} need {len(times) * a_key}"
            )
        width = targets if path == "weights" else WIDTHS[path]
        shape = (len(times), 3, width) if interpolation == "cubic" else (len(times), width)
        values = raw.reshape(shape)
        if path == "rotation":
            values = _unit_keys(values, reference, interpolation == "cubic")
        return Channel(node, path, times, values, interpolation)

    def _times(self, reference: Field) -> F64:
        times = self._accessors.floats(reference, (1,))[:, 0].astype(np.float64)
        if not np.isfinite(times).all():
            key = int(np.flatnonzero(~np.isfinite(times))[0])
            raise reference.error(f"time {key} is NaN or infinite")
        if times[0] < 0.0:
            raise reference.error(f"time 0 is negative ({times[0]:g})")
        late = np.flatnonzero(np.diff(times) <= 0.0)
        if len(late):
            raise reference.error(f"times do not increase at key {int(late[0]) + 1}")
        return times

    def _target_count(self, target: Field, node: int) -> int:
        mesh = self._nodes[node].index_or_none("mesh", len(self._meshes), "meshes")
        primitives = self._meshes[mesh].elements("primitives") if mesh is not None else []
        count = len(primitives[0].elements("targets")) if primitives else 0
        if not count:
            raise target.error(f"node {node} has no morph targets")
        return count


def _unit_keys(values: F64, reference: Field, cubic: bool) -> F64:
    """Quaternions at length 1; tangents stay as they are."""
    quaternions = values[:, VALUE] if cubic else values
    length = np.linalg.norm(quaternions, axis=1, keepdims=True)
    if not length.all():
        key = int(np.flatnonzero(length[:, 0] == 0.0)[0])
        raise reference.error(f"key {key} is a quaternion of length 0")
    unit = values.copy()
    unit[:, VALUE if cubic else slice(None)] = quaternions / length
    return unit
