"""The triangles of blended instances, the farthest first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.resources import Buffer
from elemental.passes.scene_geometry import SceneGeometry
from elemental.passes.scene_pack import DRAW_COMMAND, Array, Batch
from elemental.scene.model import Scene

LARGEST = 4096
"""Triangles of an instance that are still sorted: half a millisecond of numpy [measured]."""


@dataclass
class SortedMesh:
    """One instance's triangles: `indices` (T, 3) uint32, `centers` (T, 3), in local space."""

    number: int
    first_index: int
    indices: Array
    centers: Array
    seen_from: bytes = b""


class TriangleOrder:
    """Draws of blended instances whose triangles are sorted by their distance to an eye.

    Those that bend, or have more than LARGEST triangles, are not among them.
    """

    def __init__(
        self, device: Device, scene: Scene, geometry: SceneGeometry, batches: Sequence[Batch]
    ) -> None:
        self._meshes: dict[int, SortedMesh] = {}
        first = 0
        commands = []
        for batch in batches:
            mesh = scene.meshes[scene.instances[batch.instance].mesh]
            if batch.instance in geometry.own or not 1 < mesh.triangle_count <= LARGEST:
                continue
            corners = mesh.indices.astype("<u4").reshape(-1, 3)
            centers = mesh.positions[corners].mean(axis=1, dtype=np.float64)
            number = len(self._meshes)
            self._meshes[batch.instance] = SortedMesh(number, first, corners, centers)
            vertex = int(geometry.packed.placed_vertex[batch.instance])
            commands.append((corners.size, 1, first, vertex, number))
            first += corners.size
        self._buffers: list[Buffer] = []
        if not self._meshes:
            return

        def upload(name: str, values: Array, dynamic: bool = False) -> Buffer:
            made = device.buffer(f"sorted.{name}", values, category="meshes", dynamic=dynamic)
            self._buffers.append(made)
            return made

        self._commands = upload("draws", np.array(commands, DRAW_COMMAND))
        self._indices = upload("indices", np.zeros(first, "<u4"), dynamic=True)
        instances = upload("instances", np.array(list(self._meshes), "<u4"))
        vertices = [*geometry.attributes(), (instances, "1u/i", ("a_instance",))]
        self._vertices = device.vertex_input(vertices, self._indices)

    def __contains__(self, instance: int) -> bool:
        return instance in self._meshes

    def sort(self, instance: int, world_from_local: Array, eye: Array) -> None:
        """Have one of them drawn as seen from eye (3,); nothing is done where nothing moved."""
        mesh = self._meshes[instance]
        key = world_from_local.tobytes() + eye.tobytes()
        if key == mesh.seen_from:
            return
        mesh.seen_from = key
        matrix = world_from_local.astype(np.float64)
        offset = mesh.centers @ matrix[:3, :3].T + (matrix[:3, 3] - eye)
        order = np.argsort(-np.einsum("ij,ij->i", offset, offset), kind="stable")
        self._indices.write(mesh.indices.take(order, axis=0), 4 * mesh.first_index)

    def draw(self, encoder: Encoder, instance: int) -> None:
        """Draw one of them, textures and state as they are."""
        encoder.draw_indirect(self._vertices, self._commands, 1, self._meshes[instance].number)

    def release(self) -> None:
        """Free the buffers."""
        if self._meshes:
            self._vertices.release()
        for buffer in self._buffers:
            buffer.release()
