"""The scene's meshes and materials on the device: drawn, and moved by poses."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from elemental.core.layout import Block
from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref
from elemental.gpu.resources import Buffer
from elemental.passes import material_pack, scene_pack
from elemental.passes.culling import Culling
from elemental.passes.instance_table import Change, InstanceTable
from elemental.passes.material_pack import ALL_SLOTS, CATEGORIES, SLOTS
from elemental.passes.material_table import MaterialTable
from elemental.passes.material_textures import MaterialTextures
from elemental.passes.placed import Placed
from elemental.passes.scene_displace import displacements
from elemental.passes.scene_geometry import SceneGeometry
from elemental.passes.scene_pack import BLEND, OPAQUE, Array, Batch
from elemental.passes.triangle_lists import TriangleLists
from elemental.passes.triangle_order import TriangleOrder
from elemental.scene.area_lights import AreaLight
from elemental.scene.evaluate import Pose
from elemental.scene.model import AlphaMode, Material, Scene

INSTANCE_FORMAT = "16f 16f 4u 64x/i"
RESTLESS_REPAINTS = 2
"""Changes of material after which an instance counts as dynamic."""
INSTANCE_NAMES = ("a_world_from_local", "a_normal_from_local", "a_instance_words")
"""Members of struct Instance as attributes; the last holds its four words."""


class GpuScene:
    """A scene's geometry: merged vertex and index buffers drawn indirectly.

    `instances` is the storage block of glsl/shared, `materials` has that of the materials. `bounds`
    is the box in m (min, max) that the scene never leaves. `lists` is what voxelization draws; what
    `area_lights` emit is left out of the voxels.

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

    def _upload(self, name: str, values: Array, dynamic: bool = False) -> Buffer:
        return self._device.buffer(f"scene.{name}", values, category="meshes", dynamic=dynamic)

    def _spread(self) -> None:
        """Give boxes and bounds the room that materials may displace things into."""
        margins = displacements(self._scene)
        self._table.set_margins(margins)
        low, high = self._scene.bounds()
        self.bounds = (low - margins.max(), high + margins.max())

    def _arrange(self) -> None:
        """Sort the instances into batches, with all that hangs on their order."""
        commands, numbers, self._batches = scene_pack.pack_draws(
            self._scene, self.geometry.packed, self.dynamic
        )
        self._textures.upload(self._batches)
        table = self._table
        self._culling = Culling(commands, numbers, table.low, table.high, table.visible)
        self._commands, self._order = commands, numbers
        self._everything = self._place("everything")
        self._seen_by: dict[str, Placed] = {}
        self.lists = TriangleLists(
            self._device, commands, numbers, self.geometry.indices, self.dynamic
        )
        blended = self.batches(BLEND)
        self._sorted = TriangleOrder(self._device, self._scene, self.geometry, blended)
        placement = (self.instances, INSTANCE_FORMAT, INSTANCE_NAMES)
        attributes = [*self.geometry.attributes(), placement]
        self._listed = self._device.vertex_input(attributes, self.lists.indices)

    def _place(self, name: str) -> Placed:
        order = self._upload(f"order.{name}", self._order, dynamic=True)
        position, surface = self.geometry.attributes()
        instance = (order, "1u/i", ("a_instance",))
        return Placed(
            self._upload(f"draws.{name}", self._commands, dynamic=True),
            order,
            self._device.vertex_input([position, surface, instance], self.geometry.indices),
            self._device.vertex_input([position, instance], self.geometry.indices),
        )

    def _release_order(self) -> None:
        for placed in (self._everything, *self._seen_by.values()):
            placed.release()
        self._listed.release()
        self._sorted.release()
        self.lists.release()

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
        for change in self._table.set_area_lights(area_lights):
            self._material_changes.setdefault(change.instance, change)
            row = self._table.rows[change.instance]
            self.instances.write(row.tobytes(), change.instance * row.nbytes)

    def reads(self) -> dict[str, Ref]:
        """What every pass that draws meshes with their materials reads."""
        return {"Instances": self.instances, **self.materials.reads()}

    def params(self) -> dict[str, Block]:
        """The uniform blocks of every pass that draws meshes with their materials."""
        return self.materials.params()

    def look(self, viewer: str, clip_from_world: Array) -> None:
        """Leave out of the draws `seen_by` this viewer what its (4, 4) matrix can't see."""
        changed = self._culling.look(viewer, clip_from_world)
        if changed is not None:
            commands, order = changed
            if viewer not in self._seen_by:
                self._seen_by[viewer] = self._place(viewer)
            self._seen_by[viewer].commands.write(commands)
            self._seen_by[viewer].order.write(order)

    def _placed(self, viewer: str | None) -> Placed:
        return self._everything if viewer is None else self._seen_by[viewer]

    def batches(
        self, alpha_modes: Collection[AlphaMode], dynamic: bool | None = None
    ) -> list[Batch]:
        """The batches of these alpha modes; `dynamic` keeps those that can, or can't, move."""
        wanted = (True, False) if dynamic is None else (dynamic,)
        return [
            batch
            for batch in self._batches
            if batch.alpha_mode in alpha_modes and batch.dynamic in wanted
        ]

    def back_to_front(self, eye: Array, clip_from_world: Array) -> list[Batch]:
        """The blended batches in sight, one an instance, by the distance of its centre to eye (3,).

        clip_from_world (4, 4): the viewer's. `draw_sorted` then draws their triangles in that order
        too.
        """
        batches = self.batches(BLEND)
        if not batches:
            return []
        seen = self._culling.visible(clip_from_world)
        distance = np.linalg.norm(self._culling.centers - eye, axis=1)
        shown = [batch for batch in batches if seen[batch.instance]]
        for batch in shown:
            if batch.instance in self._sorted:
                row = self._table.rows[batch.instance]
                self._sorted.sort(batch.instance, row["world_from_local"].T, eye)
        return sorted(shown, key=lambda batch: float(distance[batch.instance]), reverse=True)

    def box(self, instance: int) -> tuple[Array, Array]:
        """World-space (low, high), each (3,) m, of an instance now."""
        return self._table.low[instance], self._table.high[instance]

    def transmits(self, batch: Batch) -> bool:
        """Whether what is behind a blended batch is seen through it, bent and tinted."""
        mesh = self._scene.meshes[self._scene.instances[batch.instance].mesh]
        return self._scene.materials[mesh.material].transmits

    def draw(
        self,
        encoder: Encoder,
        batches: Iterable[Batch],
        *,
        texture_mask: int = ALL_SLOTS,
        cull: bool = True,
        seen_by: str | None = None,
    ) -> None:
        """Draw batches with every attribute.

        `texture_mask`: the shader's MATERIAL_TEXTURES. `cull` hides the back faces of single-sided
        materials; without it the pass's state stays. `seen_by`: a viewer given to `look`.
        """
        placed = self._placed(seen_by)
        for batch in self.textured(encoder, batches, texture_mask):
            if cull:
                encoder.set(cull="none" if batch.double_sided else "back")
            encoder.draw_indirect(placed.vertices, placed.commands, batch.count, batch.first)

    def draw_sorted(self, encoder: Encoder, batches: Iterable[Batch], seen_by: str) -> None:
        """Draw batches of `back_to_front`, culling left as it is."""
        placed = self._placed(seen_by)
        for batch in self.textured(encoder, batches):
            if batch.instance in self._sorted:
                self._sorted.draw(encoder, batch.instance)
            else:
                encoder.draw_indirect(placed.vertices, placed.commands, batch.count, batch.first)

    def draw_listed(
        self, encoder: Encoder, batches: Iterable[Batch], view: int, *, texture_mask: int
    ) -> None:
        """Draw what `lists` holds of the batches for a view, culling left as it is.

        The instance comes as the attributes INSTANCE_NAMES. The pass names the lists' commands and
        indices in ``uses``.
        """
        for batch in self.textured(encoder, batches, texture_mask):
            instances = self._culling.instances_of(batch)
            first = self.lists.first_command(view) + instances.start
            encoder.draw_indirect(self._listed, self.lists.commands, len(instances), first)

    def hold_textures(self, batches: Collection[Batch]) -> None:
        """Make the textures of batches that others draw."""
        self._textures.upload(batches)

    def textured(
        self, encoder: Encoder, batches: Iterable[Batch], texture_mask: int = ALL_SLOTS
    ) -> Iterator[Batch]:
        """Each batch, once its textures are bound."""
        bound: dict[str, int] = {}
        for batch in batches:
            for index, (slot, texture) in enumerate(zip(SLOTS, batch.textures, strict=True)):
                if texture_mask >> index & 1 and bound.get(slot) != texture:
                    encoder.bind(f"u_{slot}_texture", self._textures.sampled(slot, texture))
                    bound[slot] = texture
            for own in batch.own_textures:
                encoder.bind(f"u_{own.name}", self._textures.own(own))
            yield batch

    def draw_positions(
        self,
        encoder: Encoder,
        alpha_modes: Collection[AlphaMode] = OPAQUE,
        *,
        dynamic: bool | None = None,
        seen_by: str | None = None,
    ) -> None:
        """Draw with the attributes a_position and a_instance only, culling left as it is.

        `dynamic` as for `batches`.
        """
        placed = self._placed(seen_by)
        for mode in CATEGORIES:
            batches = self.batches((mode,), dynamic) if mode in alpha_modes else []
            if batches:
                count, first = sum(batch.count for batch in batches), batches[0].first
                encoder.draw_indirect(placed.positions_only, placed.commands, count, first)
