"""Meshes that bend: what their vertices hang on, and the pass that moves them."""

from __future__ import annotations

from collections.abc import Callable, Collection

import numpy as np

from elemental.core.errors import InputError
from elemental.core.layout import layouts, pack, pack_array
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.resources import Buffer
from elemental.gpu.shaders import Compute
from elemental.passes.scene_pack import Array, Geometry, bending
from elemental.scene.evaluate import Pose
from elemental.scene.model import Mesh, Scene

DEFORM = Compute("scene/deform.comp.glsl")


class Deformer:
    """Moves the vertices of a scene's bending instances into ranges of their own.

    positions, surface: the buffers of `scene_pack.pack_geometry`. Raises InputError for meshes that
    are larger than the driver's storage blocks.
    """

    def __init__(
        self, device: Device, scene: Scene, geometry: Geometry, positions: Buffer, surface: Buffer
    ) -> None:
        self._positions, self._surface = positions, surface
        self._groups, self._owners = pack_groups(scene, geometry)
        meshes = [scene.meshes[m] for m in _bending_meshes(scene)]
        self._first_joint, joints = _first_entries(scene, "skin")
        self._first_weight, weights = _first_entries(scene, "weights")
        self._joints = np.tile(np.eye(4, dtype="<f4"), (max(joints, 1), 1, 1))
        self._weights = np.zeros(max(weights, 1), "<f4")
        self._stale: set[int] = set()
        self._listed: frozenset[int] = frozenset()
        packed = {
            "groups": self._groups,
            "influences": np.concatenate([np.zeros((1, 2), "<u4"), *map(pack_influences, meshes)]),
            "joints": self._joints,
            "morphs": np.concatenate([np.zeros((1, 9), "<f4"), *map(pack_morphs, meshes)]),
            "weights": self._weights,
        }
        largest = max(surface.nbytes, *(values.nbytes for values in packed.values()))
        if largest > device.storage_limit:
            reason = "has more vertices than this driver can bend; --set scene.animation=none"
            raise InputError(scene.path, "", reason)
        self._buffers = {
            name: device.buffer(f"scene.{name}", values, category="meshes", dynamic=True)
            for name, values in packed.items()
        }

    def follow(self, pose: Pose) -> list[int]:
        """Take over a pose's joints and weights. Returns the instances that bend otherwise now."""
        bent: dict[int, None] = {}
        for entries, first, values, name in (
            (pose.joints, self._first_joint, self._joints, "joints"),
            (pose.weights, self._first_weight, self._weights, "weights"),
        ):
            written: list[int] = []
            for instance, entry in entries.items():
                if instance not in first:
                    continue
                stored = entry.swapaxes(-1, -2) if name == "joints" else entry  # by columns
                rows = slice(first[instance], first[instance] + len(entry))
                if not np.array_equal(values[rows], stored):
                    values[rows] = stored
                    bent[instance] = None
                    written += [rows.start, rows.stop]
            if written:
                low, high = min(written), max(written)
                self._buffers[name].write(values[low:high], low * values[0].nbytes)
        self._stale |= bent.keys()
        return list(bent)

    def mark(self, instances: Collection[int]) -> None:
        """Have some instances bent anew, as the last pose has them."""
        self._stale |= set(instances)

    def run(self, g: Graph) -> None:
        """Add the pass that the last poses ask for: none where nothing bends otherwise."""
        if not self._stale:
            return
        chosen = np.isin(self._owners, list(self._stale))
        if self._listed != self._stale:
            self._buffers["groups"].write(self._groups[chosen])
            self._listed = frozenset(self._stale)
        self._stale.clear()
        reads = {name.capitalize(): buffer for name, buffer in self._buffers.items()}
        count = int(chosen.sum())
        g.compute(
            DEFORM,
            "scene.deform",
            reads=reads,
            writes={"Positions": self._positions, "Surface": self._surface},
            params={"Deform": pack(layouts().block("Deform"), groups=np.uint32(count))},
            threads=count * int(layouts().constant("DEFORM_GROUP")),
        )

    def release(self) -> None:
        """Free everything but the buffers that were given."""
        for buffer in self._buffers.values():
            buffer.release()


def _bending_meshes(scene: Scene) -> list[int]:
    return sorted({scene.instances[number].mesh for number in bending(scene)})


def _first_entries(scene: Scene, what: str) -> tuple[dict[int, int], int]:
    """(first joint or weight of each instance that has some, how many there are)."""
    first: dict[int, int] = {}
    count = 0
    for number in bending(scene):
        instance = scene.instances[number]
        if what == "skin" and instance.skin >= 0 and scene.motion is not None:
            first[number] = count
            count += len(scene.motion.skins[instance.skin].joints)
        elif what == "weights" and instance.weights is not None:
            first[number] = count
            count += len(instance.weights)
    return first, count


def pack_groups(scene: Scene, geometry: Geometry) -> tuple[Array, Array]:
    """((G,) of the GLSL struct DeformGroup, (G,) the instance that each belongs to)."""
    size = int(layouts().constant("DEFORM_GROUP"))
    first_joint, first_weight = (_first_entries(scene, what)[0] for what in ("skin", "weights"))
    first_influence = _offsets(scene, lambda mesh: mesh_influences(mesh) * len(mesh.positions))
    first_morph = _offsets(scene, lambda mesh: mesh_targets(mesh) * len(mesh.positions))
    rows, owners = [], []
    for number in bending(scene):
        index = scene.instances[number].mesh
        mesh = scene.meshes[index]
        count = len(mesh.positions)
        influences = mesh_influences(mesh) if number in first_joint else 0
        targets = mesh_targets(mesh) if number in first_weight else 0
        for start in range(0, count, size):
            rows.append((
                int(geometry.first_vertex[index]) + start,
                int(geometry.placed_vertex[number]) + start,
                min(size, count - start),
                influences,
                first_influence[index] + influences * start,
                first_joint.get(number, 0),
                first_morph[index] + start,
                count,
                first_weight.get(number, 0),
                targets,
            ))  # fmt: skip
            owners.append(number)
    columns = list(zip(*rows, strict=True)) or [()] * 10
    names = ("source", "target", "vertices", "influences", "first_influence", "first_joint",
             "first_morph", "target_stride", "first_weight", "weights")  # fmt: skip
    fields = dict(zip(names, columns, strict=True))
    return pack_array(layouts().struct("DeformGroup"), len(rows), **fields), np.array(owners, int)


def mesh_influences(mesh: Mesh) -> int:
    """Joints a vertex."""
    return 0 if mesh.influences is None else mesh.influences.joints.shape[1]


def mesh_targets(mesh: Mesh) -> int:
    """Morph targets."""
    return 0 if mesh.morphs is None else len(mesh.morphs)


def _offsets(scene: Scene, size: Callable[[Mesh], int]) -> dict[int, int]:
    """By mesh that bends: where its entries begin, behind the one that stands for none."""
    offsets, count = {}, 1
    for index in _bending_meshes(scene):
        offsets[index] = count
        count += size(scene.meshes[index])
    return offsets


def pack_influences(mesh: Mesh) -> Array:
    """(N * K, 2) uint32: joint and the bits of its weight, a vertex's K in a row."""
    if mesh.influences is None:
        return np.empty((0, 2), "<u4")
    joints = mesh.influences.joints.astype("<u4").reshape(-1)
    weights = mesh.influences.weights.astype("<f4").reshape(-1).view("<u4")
    return np.stack([joints, weights], axis=1)


def pack_morphs(mesh: Mesh) -> Array:
    """(T * N, 9) float32: what each target adds to position, normal and tangent of each vertex."""
    if mesh.morphs is None:
        return np.empty((0, 9), "<f4")
    morphs = mesh.morphs
    rows = np.concatenate([morphs.positions, morphs.normals, morphs.tangents], axis=2)
    return rows.reshape(-1, 9).astype("<f4")
