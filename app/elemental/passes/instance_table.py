"""The instances as the GPU holds them, and what a new pose changes of them. No GL here."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np

from elemental.passes.scene_pack import (
    Array,
    bending,
    instance_boxes,
    instance_flags,
    pack_instances,
)
from elemental.scene.area_lights import AreaLight
from elemental.scene.boxes import MeshBoxes
from elemental.scene.evaluate import Pose
from elemental.scene.model import FloatArray, Scene

IDENTITY = np.eye(4, dtype=np.float32)[None]

Box = tuple[FloatArray, FloatArray]
"""World (low, high), each (3,) float32 m."""


@dataclass(frozen=True)
class Change:
    """What became of one instance since the frame before.

    before, after: its world boxes, None where it was or is hidden. `moved`: its surface is
    elsewhere or of another shape; else only its material changed. `casts`: so may its shadow be.
    """

    instance: int
    before: Box | None
    after: Box | None
    moved: bool
    casts: bool


class InstanceTable:
    """Rows (N,) of the GLSL struct Instance with the world boxes (N, 3) low and high, and which are
    visible (N,) bool."""

    def __init__(self, scene: Scene, area_lights: Sequence[AreaLight]) -> None:
        self.rows = pack_instances(scene, area_lights)
        self.low, self.high = (box.astype(np.float32) for box in instance_boxes(scene))
        self.visible = np.ones(len(self.rows), np.bool_)
        self._dynamic = np.array([n for n, i in enumerate(scene.instances) if i.dynamic], np.int64)
        self._world = np.array([i.world_from_local for i in scene.instances], np.float32)
        shapes: dict[int, MeshBoxes] = {}
        for number in self._dynamic.tolist():
            mesh = scene.instances[number].mesh
            if mesh not in shapes:
                shapes[mesh] = MeshBoxes(scene.meshes[mesh])
        self._shapes = [shapes.get(instance.mesh) for instance in scene.instances]
        self._bends = np.zeros(len(self.rows), np.bool_)
        self._bends[bending(scene)] = True
        self._local_low, self._local_high = np.zeros((2, len(self.rows), 3))
        for number in self._dynamic.tolist():
            local = shapes[scene.instances[number].mesh].around(IDENTITY)
            self._local_low[number], self._local_high[number] = local
        self._is_posed = False
        self.margins = np.zeros(len(self.rows), np.float32)

    def set_margins(self, margins: Array) -> None:
        """Widen the boxes by (N,) m to every side, instead of by what they were widened before."""
        wider = (margins - self.margins)[:, None]
        self.low -= wider
        self.high += wider
        self.margins = margins

    def follow(self, pose: Pose, bent: Collection[int]) -> tuple[list[Change], range]:
        """Take over a pose; `bent`: the instances whose shape it changed.

        Returns (changes, the rows that differ from before: first to last). Rows whose instance only
        came to rest differ by their previous transform.
        """
        if len(pose.instances) == 0:
            return [], range(0)
        numbers = pose.instances
        moved = (pose.world_from_local != self._world[numbers]).any(axis=(1, 2)) & pose.visible
        shown = pose.visible != self.visible[numbers]
        changed = moved | shown
        if bent:
            changed |= np.isin(numbers, list(bent)) & pose.visible
        resting = self._come_to_rest(numbers)
        changes: list[Change] = []
        if changed.any():
            touched, visible = numbers[changed], pose.visible[changed]
            before = [self._box(n) for n in touched.tolist()]
            self._place(touched, pose.world_from_local[changed], visible)
            self._fit(touched[visible], pose)
            changes = [
                Change(number, box, self._box(number), True, True)
                for number, box in zip(touched.tolist(), before, strict=True)
            ]
        written = np.concatenate([numbers[changed], resting])
        self._is_posed = True
        return changes, range(int(written.min()), int(written.max()) + 1) if len(
            written
        ) else range(0)

    def material_changes(self, scene: Scene, material: int, casts: bool) -> list[Change]:
        """The visible instances that use a material; `casts`: it now lets other light through."""
        using = self.users(scene, lambda number: number == material) & self.visible
        users: list[int] = np.flatnonzero(using).tolist()
        return [Change(n, self._box(n), self._box(n), False, casts) for n in users]

    @staticmethod
    def users(scene: Scene, wanted: Callable[[int], bool]) -> Array:
        """(N,) bool: the instances whose material's number is wanted."""
        chosen = np.array([wanted(k) for k in range(len(scene.materials))], np.bool_)
        return chosen[[scene.meshes[instance.mesh].material for instance in scene.instances]]

    def set_area_lights(self, scene: Scene, area_lights: Sequence[AreaLight]) -> list[Change]:
        """Flag the instances that are area lights. Returns those that become or cease to be."""
        flags = instance_flags(scene, area_lights)
        differ = np.flatnonzero(flags != self.rows["flags"]).tolist()
        self.rows["flags"] = flags
        return [Change(n, self._box(n), self._box(n), False, False) for n in differ]

    def _box(self, number: int) -> Box | None:
        if not self.visible[number]:
            return None
        return self.low[number].copy(), self.high[number].copy()

    def _come_to_rest(self, numbers: Array) -> Array:
        """Let the previous transforms be the present ones, before those change. Returns whose
        differed."""
        now = self.rows["world_from_local"][numbers]
        differ = (self.rows["prev_world_from_local"][numbers] != now).any(axis=(1, 2))
        resting: Array = numbers[differ]
        self.rows["prev_world_from_local"][resting] = now[differ]
        return resting

    def _place(self, numbers: Array, worlds: Array, visible: Array) -> None:
        """Write the rows of some instances; those not visible get matrices of zeros."""
        appear = ~self.visible[numbers] & visible
        self.visible[numbers] = visible
        shown = numbers[visible]
        self._world[shown] = worlds[visible]
        normals = np.zeros((len(numbers), 4, 4), np.float32)
        linear = worlds[visible][:, :3, :3].astype(np.float64)
        normals[visible, :3, :3] = np.linalg.inv(linear).swapaxes(-1, -2)
        normals[visible, 3, 3] = 1.0
        placed = np.where(visible[:, None, None], worlds, np.float32(0.0))
        by_columns = placed.swapaxes(-1, -2)
        self.rows["world_from_local"][numbers] = by_columns
        self.rows["normal_from_local"][numbers] = normals.swapaxes(-1, -2)
        fresh = appear | (not self._is_posed)
        self.rows["prev_world_from_local"][numbers[fresh]] = by_columns[fresh]

    def _fit(self, numbers: Array, pose: Pose) -> None:
        """Bring the boxes of visible instances up to a pose."""
        rigid = numbers[~self._bends[numbers]]
        m = self._world[rigid].astype(np.float64)
        low, high = self._local_low[rigid], self._local_high[rigid]
        center = np.einsum("nij,nj->ni", m[:, :3, :3], (low + high) / 2) + m[:, :3, 3]
        reach = np.einsum("nij,nj->ni", np.abs(m[:, :3, :3]), (high - low) / 2)
        reach += self.margins[rigid, None]
        self.low[rigid], self.high[rigid] = center - reach, center + reach
        for number in numbers[self._bends[numbers]].tolist():
            shape = self._shapes[number]
            assert shape is not None, "a pose bends dynamic instances only"
            joints, weights = pose.joints.get(number), pose.weights.get(number)
            self.low[number], self.high[number] = shape.around(
                self._world[number][None],
                None if joints is None else joints[None],
                None if weights is None else weights[None],
            )
            self.low[number] -= self.margins[number]
            self.high[number] += self.margins[number]
