"""The scene's meshes and materials on the device: drawn, and moved by poses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from elemental.core.layout import Block
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref
from elemental.passes import material_pack
from elemental.passes.instance_table import Change, InstanceTable
from elemental.passes.material_table import MaterialTable
from elemental.passes.material_textures import MaterialTextures
from elemental.passes.scene_displace import displacements
from elemental.passes.scene_draws import SceneDraws
from elemental.passes.scene_geometry import SceneGeometry
from elemental.passes.scene_pack import Array, Batch
from elemental.scene.area_lights import AreaLight
from elemental.scene.evaluate import Pose
from elemental.scene.model import Material, Scene

RESTLESS_REPAINTS = 2
"""Changes of material after which an instance counts as dynamic."""


class GpuScene(SceneDraws):
    """A scene's geometry: merged vertex and index buffers drawn indirectly.

    `instances` is the storage block of glsl/shared, `materials` has that of the materials. `bounds`
    is the box in m (min, max) that the scene never leaves. What `area_lights` emit is left out of
    the voxels.

    Once a frame `update` takes over a pose, and `deform` bends what it bends. `changes` is then
    what became of the instances since the frame before, and `version` counts the frames with any.
    Instances are `dynamic` (N,) bool where a pose may ever change them, and from their third
    material on. Nothing of this is read back from the GPU.
    """

    def __init__(self, device: Device, scene: Scene, area_lights: Sequence[AreaLight] = ()) -> None:
        self.version = 0
        self.changes: list[Change] = []
        self.bounds = scene.bounds()
        self.triangle_count = scene.triangle_count
        self.dynamic = np.array([instance.dynamic for instance in scene.instances], np.bool_)
        self._device, self._scene = device, scene
        self._table = InstanceTable(scene, area_lights)
        self._material_changes: dict[int, Change] = {}
        self._repaints = np.zeros(len(scene.instances), np.int64)
        self.instances = self._upload("instances", self._table.rows, dynamic=True)
        self.materials = MaterialTable(device, scene)
        self.dynamic |= self._table.users(scene, self.materials.is_animated)
        self.geometry = SceneGeometry(device, scene)
        self._spread()
        self._textures = MaterialTextures(device, scene)
        self._pose: Pose | None = None
        self._rests = False
        self._arrange()

    def _spread(self) -> None:
        """Give boxes and bounds the room that materials may displace things into."""
        margins = displacements(self._scene)
        self._table.set_margins(margins)
        low, high = self._scene.bounds()
        self.bounds = (low - margins.max(), high + margins.max())

    def release(self) -> None:
        """Free everything."""
        self._release_order()
        self._textures.release()
        self.materials.release()
        self.geometry.release()
        self.instances.release()

    def update(self, pose: Pose | None, time_s: float = 0.0) -> bool:
        """Begin a frame: take over its pose (None: nothing moved) and list the `changes`.

        Uploads what differs, the rows of the changed instances at once. Materials that change with
        time change the instances that bear them.
        The very pose of a frame that moved nothing is not looked at again. Returns whether edits of
        materials were taken over.
        """
        passing, edited = self.materials.follow(time_s)
        if edited:
            self._release_order()
            self._reshape()
            self._repaint(edited)
            self._arrange()
        for index in (*passing, *edited):
            self._note_material(index, self._scene.materials[index].alpha_mode != "opaque")
        self.changes = list(self._material_changes.values())
        self._material_changes.clear()
        if pose is not None and len(pose.instances) and not (pose is self._pose and self._rests):
            bent = self.geometry.follow(pose)
            moved, rows = self._table.follow(pose, bent)
            self._pose, self._rests = pose, not moved
            if rows:
                table = self._table.rows[rows.start : rows.stop]
                self.instances.write(table, rows.start * table.itemsize)
            if moved:
                self._culling.moved()
                self.in_view.moved(rows)
                elsewhere = {change.instance for change in moved}
                self.geometry.mark_moved(elsewhere)
                stood = [change for change in self.changes if change.instance not in elsewhere]
                self.changes = [*stood, *moved]
        if self.changes:
            self.version += 1
        return bool(edited)

    def deform(self, g: Graph) -> None:
        """Add the passes that bring bent and displaced meshes up to the frame, if any has to be."""
        self.geometry.run(g, self.instances, self.materials, self._textures)

    def set_material(self, index: int, material: Material) -> None:
        """Replace a material, here and in the scene; its users are among the next `changes`."""
        before = self._scene.materials[index]
        self.materials.set(index, material)
        material = self._scene.materials[index]
        restless = self._repaint([index])
        if restless or material_pack.draw_state(before) != material_pack.draw_state(material):
            self._release_order()
            self._reshape()
            self._arrange()
        self._note_material(index, material_pack.opacity(before) != material_pack.opacity(material))

    def _note_material(self, index: int, casts: bool) -> None:
        """List the users of a material that looks otherwise now among the next `changes`."""
        displaces = self._scene.materials[index].definition.displacement_m > 0.0
        for change in self._table.material_changes(self._scene, index, casts or displaces):
            self._material_changes[change.instance] = replace(change, moved=displaces)
        self.geometry.mark_materials([index])

    def _reshape(self) -> None:
        """Take over how far materials displace now: boxes, and who has vertices of its own."""
        if np.array_equal(displacements(self._scene), self._table.margins):
            return
        self.geometry.release()
        self.geometry = SceneGeometry(self._device, self._scene)
        self._spread()
        self.version += 1  # no box of a change tells where things were: all is done anew

    def _repaint(self, materials: Sequence[int]) -> bool:
        """Count changes of materials. Returns whether more instances are dynamic for them."""
        users = self._table.users(self._scene, materials.__contains__)
        self._repaints += users
        ticking = self._table.users(self._scene, self.materials.is_animated)
        restless = ~self.dynamic & (ticking | (self._repaints >= RESTLESS_REPAINTS))
        self.dynamic |= restless
        return bool(restless.any())

    def set_area_lights(self, area_lights: Sequence[AreaLight]) -> None:
        """Replace the area lights; instances that become one, or cease to, are among `changes`."""
        for change in self._table.set_area_lights(self._scene, area_lights):
            self._material_changes.setdefault(change.instance, change)
            row = self._table.rows[change.instance]
            self.instances.write(row.tobytes(), change.instance * row.nbytes)

    def reads(self) -> dict[str, Ref]:
        """What every pass that draws meshes with their materials reads."""
        return {"u_instances": self.instances, **self.materials.reads()}

    def params(self) -> dict[str, Block]:
        """The uniform blocks of every pass that draws meshes with their materials."""
        return self.materials.params()

    def box(self, instance: int) -> tuple[Array, Array]:
        """World-space (low, high), each (3,) m, of an instance now."""
        return self._table.low[instance], self._table.high[instance]

    def transmits(self, batch: Batch) -> bool:
        """Whether what is behind a blended batch is seen through it, bent and tinted."""
        mesh = self._scene.meshes[self._scene.instances[batch.instance].mesh]
        return self._scene.materials[mesh.material].transmits
