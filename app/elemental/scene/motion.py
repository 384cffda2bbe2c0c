"""What can move, as plain arrays: a tree of nodes, key-framed tracks over it, skins and morphs.

Times are in seconds, angles in radians, quaternions x, y, z, w. `evaluate` turns all of it into the
pose of a moment.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

F32 = npt.NDArray[np.float32]
F64 = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

Path: TypeAlias = Literal["translation", "rotation", "scale", "weights", "visible"]
Interpolation: TypeAlias = Literal["step", "linear", "cubic"]

WIDTH: dict[Path, int] = {"translation": 3, "rotation": 4, "scale": 3, "visible": 1}
"""Components of a key's value; of morph weights there are as many as targets."""


@dataclass(frozen=True)
class Influences:
    """The joints that hold each vertex of a mesh: joints (N, K) int32 into the skin's list,
    weights (N, K) float32 with a sum of 1."""

    joints: npt.NDArray[np.int32]
    weights: F32

    def take(self, vertices: npt.NDArray[Any]) -> Influences:
        """Those of these vertices, in their order."""
        return Influences(self.joints[vertices], self.weights[vertices])


@dataclass(frozen=True)
class Morphs:
    """What each of T morph targets adds to a mesh at weight 1: (T, N, 3) float32 each."""

    positions: F32
    normals: F32
    tangents: F32

    def __len__(self) -> int:
        return len(self.positions)

    def take(self, vertices: npt.NDArray[Any]) -> Morphs:
        """Those of these vertices, in their order."""
        return Morphs(*(a[:, vertices] for a in (self.positions, self.normals, self.tangents)))


@dataclass(frozen=True)
class Skin:
    """joints (J,): nodes of the rig; inverse_bind (J, 4, 4) float64: joint space from mesh space.

    A vertex that joint j holds alone stands at world(joints[j]) @ inverse_bind[j] @ position.
    """

    joints: Indices
    inverse_bind: F64


@dataclass(frozen=True)
class Rig:
    """N nodes, each behind its parent: world = world(parent) @ offset @ T @ R @ S.

    parents (N,): -1 for the world itself; offsets (N, 4, 4) float64 stand for what never moves
    between a node and its parent; translations (N, 3), rotations (N, 4), scales (N, 3) float64 at
    rest, which tracks replace.
    """

    parents: Indices
    offsets: F64
    translations: F64
    rotations: F64
    scales: F64

    def __len__(self) -> int:
        return len(self.parents)

    @cached_property
    def levels(self) -> list[Indices]:
        """The nodes by their distance from the world, nearest first."""
        depth = np.zeros(len(self), np.int64)
        for node, parent in enumerate(self.parents.tolist()):
            depth[node] = depth[parent] + 1 if parent >= 0 else 0
        return [np.flatnonzero(depth == k) for k in range(int(depth.max(initial=-1)) + 1)]


@dataclass(frozen=True)
class Tracks:
    """n tracks of one kind over the same K key times.

    nodes (n,); times (K,) float64 increasing; values (n, K, W) float64, for "cubic" (n, K, 3, W):
    incoming tangent, value, outgoing tangent. They start over every `length_s` seconds, or hold the
    last key where `loop` is off.
    """

    path: Path
    nodes: Indices
    times: F64
    values: F64
    interpolation: Interpolation
    length_s: float
    loop: bool = True


@dataclass(frozen=True)
class Motion:
    """Everything in a scene that time changes. Where two tracks move one thing, the last wins."""

    rig: Rig
    tracks: Sequence[Tracks]
    skins: Sequence[Skin] = ()


@dataclass
class RigBuilder:
    """Collects nodes, tracks and skins, from several files if need be."""

    parents: list[int] = field(default_factory=list)
    offsets: list[F64] = field(default_factory=list)
    translations: list[F64] = field(default_factory=list)
    rotations: list[F64] = field(default_factory=list)
    scales: list[F64] = field(default_factory=list)
    tracks: list[Tracks] = field(default_factory=list)
    skins: list[Skin] = field(default_factory=list)

    def node(
        self,
        parent: int = -1,
        offset: npt.ArrayLike | None = None,
        translation: npt.ArrayLike = (0.0, 0.0, 0.0),
        rotation: npt.ArrayLike = (0.0, 0.0, 0.0, 1.0),
        scale: npt.ArrayLike = (1.0, 1.0, 1.0),
    ) -> int:
        """Append a node and return its number."""
        self.parents.append(parent)
        self.offsets.append(np.eye(4) if offset is None else np.array(offset, np.float64))
        self.translations.append(np.array(translation, np.float64))
        self.rotations.append(np.array(rotation, np.float64))
        self.scales.append(np.array(scale, np.float64))
        return len(self.parents) - 1

    def adopt(self, motion: Motion, parent: int, offset: F64) -> tuple[int, int]:
        """Append another motion under `parent` @ `offset`. Returns its (first node, first skin)."""
        first, rig = len(self.parents), motion.rig
        for k in range(len(rig)):
            is_root = rig.parents[k] < 0
            self.node(
                parent if is_root else int(rig.parents[k]) + first,
                offset @ rig.offsets[k] if is_root else rig.offsets[k],
                rig.translations[k],
                rig.rotations[k],
                rig.scales[k],
            )
        first_skin = len(self.skins)
        self.tracks += [
            Tracks(t.path, t.nodes + first, t.times, t.values, t.interpolation, t.length_s, t.loop)
            for t in motion.tracks
        ]
        self.skins += [Skin(skin.joints + first, skin.inverse_bind) for skin in motion.skins]
        return first, first_skin

    def motion(self) -> Motion | None:
        """What was collected; None where nothing was."""
        if not self.parents:
            return None
        rig = Rig(
            np.array(self.parents, np.int64),
            np.stack(self.offsets),
            np.stack(self.translations),
            np.stack(self.rotations),
            np.stack(self.scales),
        )
        return Motion(rig, tuple(self.tracks), tuple(self.skins))
