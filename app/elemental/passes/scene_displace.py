"""Meshes that their material displaces: which they are, and the pass that moves their vertices."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from elemental.core.layout import layouts, pack, pack_array
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref
from elemental.gpu.resources import Buffer
from elemental.gpu.shaders import Compute
from elemental.passes.material_pack import SLOTS, own_textures, texture_slots
from elemental.passes.material_snippets import NAME
from elemental.passes.material_table import MaterialTable
from elemental.passes.material_textures import MaterialTextures
from elemental.passes.scene_pack import Array, Geometry, bending
from elemental.scene.model import Material, Scene

SHADER = "scene/displace.comp.glsl"


def displacements(scene: Scene) -> Array:
    """(N,) float32 m: how far each instance's material may displace it."""
    of_material = [material.definition.displacement_m for material in scene.materials]
    return np.array(
        [of_material[scene.meshes[i.mesh].material] for i in scene.instances], np.float32
    )


def displaced(scene: Scene) -> list[int]:
    """Numbers of the instances whose material displaces them."""
    numbers: list[int] = np.flatnonzero(displacements(scene)).tolist()
    return numbers


class Displacer:
    """Moves the vertices of displaced instances into ranges of their own, for the materials that
    `mark` names: those that changed, or whose users did. It runs behind the Deformer."""

    def __init__(
        self, device: Device, scene: Scene, geometry: Geometry, positions: Buffer, surface: Buffer
    ) -> None:
        self._scene, self._positions, self._surface = scene, positions, surface
        self._groups: dict[int, Buffer] = {}
        self._counts: dict[int, int] = {}
        self.users: dict[int, list[int]] = {}
        """The displaced instances of each material that displaces."""
        for number in displaced(scene):
            material = scene.meshes[scene.instances[number].mesh].material
            self.users.setdefault(material, []).append(number)
        for material, numbers in self.users.items():
            groups = pack_groups(scene, geometry, numbers)
            name = f"scene.displaced.{material}"
            self._groups[material] = device.buffer(name, groups, category="meshes")
            self._counts[material] = len(groups)
        self._stale = set(self.users)

    def mark(self, materials: Collection[int]) -> None:
        """Have the users of these materials moved anew, where those displace."""
        self._stale |= self.users.keys() & materials

    def mark_instances(self, instances: Collection[int]) -> None:
        """Have these instances moved anew, where their materials displace them."""
        moved = set(instances)
        self._stale |= {m for m, users in self.users.items() if not moved.isdisjoint(users)}

    def bent(self) -> set[int]:
        """The instances that the next `run` moves further from where the Deformer bends them."""
        bends = set(bending(self._scene))
        return {number for m in self._stale for number in self.users[m]} & bends

    def run(
        self, g: Graph, instances: Buffer, materials: MaterialTable, textures: MaterialTextures
    ) -> None:
        """Add a pass for each material that was marked."""
        for index in sorted(self._stale):
            material = self._scene.materials[index]
            count = self._counts[index]
            block = pack(
                layouts().block("Displace"),
                groups=np.uint32(count),
                farthest_m=np.float32(material.definition.displacement_m),
            )
            g.compute(
                Compute(SHADER, snippets={NAME: material.definition.key}),
                f"scene.displace.{material.definition.name}",
                reads={
                    "DisplaceGroups": self._groups[index],
                    "Instances": instances,
                    **materials.reads(),
                    **_textures(material, textures),
                },
                writes={"Positions": self._positions, "SurfaceVertices": self._surface},
                params={"Displace": block, **materials.params()},
                threads=count * int(layouts().constant("DEFORM_GROUP")),
            )
        self._stale.clear()

    def release(self) -> None:
        """Free everything but the buffers that were given."""
        for buffer in self._groups.values():
            buffer.release()


def _textures(material: Material, textures: MaterialTextures) -> dict[str, Ref]:
    """All textures of a material by their GLSL names."""
    slots = zip(SLOTS, texture_slots(material), strict=True)
    found: dict[str, Ref] = {
        f"u_{name}_texture": textures.sampled(name, -1 if slot is None else slot.texture)
        for name, slot in slots
    }
    return found | {f"u_{own.name}": textures.own(own) for own in own_textures(material)}


def pack_groups(scene: Scene, geometry: Geometry, numbers: Collection[int]) -> Array:
    """(G,) of the GLSL struct DisplaceGroup for some instances.

    A bent one is displaced where it was bent to.
    """
    size = int(layouts().constant("DEFORM_GROUP"))
    bends = set(bending(scene))
    rows = []
    for number in numbers:
        mesh = scene.instances[number].mesh
        count = len(scene.meshes[mesh].positions)
        target = int(geometry.placed_vertex[number])
        source = target if number in bends else int(geometry.first_vertex[mesh])
        for start in range(0, count, size):
            rows.append((source + start, target + start, min(size, count - start), number))
    source_, target_, vertices, instance = np.array(rows, "<u4").T
    return pack_array(
        layouts().struct("DisplaceGroup"),
        len(rows),
        source=source_,
        target=target_,
        vertices=vertices,
        instance=instance,
    )
