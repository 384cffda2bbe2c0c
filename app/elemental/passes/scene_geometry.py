"""The vertices of a scene on the device, and what moves them against each other."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.resources import Buffer
from elemental.passes import scene_pack
from elemental.passes.material_table import MaterialTable
from elemental.passes.material_textures import MaterialTextures
from elemental.passes.scene_deform import Deformer
from elemental.passes.scene_displace import Displacer, displaced
from elemental.scene.evaluate import Pose
from elemental.scene.model import Scene

SURFACE_NAMES = scene_pack.SURFACE_VERTEX.names or ()
SURFACE_FORMAT = "3f 4f 2f 2f 4f1"


class SceneGeometry:
    """Merged vertex and index buffers; instances that bend or are displaced have vertices of their
    own, which `run` fills."""

    def __init__(self, device: Device, scene: Scene) -> None:
        bending = scene_pack.bending(scene)
        own = sorted({*bending, *displaced(scene)})
        self.packed = scene_pack.pack_geometry(scene, own)
        self.own = frozenset(own)
        """Numbers of the instances with vertices of their own."""

        def upload(name: str, values: scene_pack.Array) -> Buffer:
            return device.buffer(f"scene.{name}", values, category="meshes")

        self.indices = upload("indices", self.packed.indices)
        self.positions = upload("positions", self.packed.positions)
        self.surface = upload("surface", self.packed.surface)
        vertices = (self.packed, self.positions, self.surface)
        self._deformer = Deformer(device, scene, *vertices) if bending else None
        self._displacer = Displacer(device, scene, *vertices) if displaced(scene) else None

    def attributes(self) -> list[tuple[Buffer, str, Sequence[str]]]:
        """Of a vertex: its position, then the rest."""
        surface = (self.surface, SURFACE_FORMAT, SURFACE_NAMES)
        return [(self.positions, "3f", ("a_position",)), surface]

    def follow(self, pose: Pose) -> list[int]:
        """Take over a pose's joints and weights. Returns the instances that bend otherwise now."""
        return self._deformer.follow(pose) if self._deformer is not None else []

    def mark_moved(self, instances: Collection[int]) -> None:
        """Some instances were moved or bent: what their materials do to them depends on it."""
        if self._displacer is not None:
            self._displacer.mark_instances(instances)

    def mark_materials(self, materials: Collection[int]) -> None:
        """Some materials displace otherwise now."""
        if self._displacer is not None:
            self._displacer.mark(materials)

    def run(
        self, g: Graph, instances: Buffer, materials: MaterialTable, textures: MaterialTextures
    ) -> None:
        """Add the passes that bring the vertices up to date: none where nothing changed."""
        if self._deformer is not None:
            if self._displacer is not None:
                self._deformer.mark(self._displacer.bent())
            self._deformer.run(g)
        if self._displacer is not None:
            self._displacer.run(g, instances, materials, textures)

    def release(self) -> None:
        """Free the buffers."""
        for part in (self._deformer, self._displacer):
            if part is not None:
                part.release()
        for buffer in (self.indices, self.positions, self.surface):
            buffer.release()
