"""What is drawn of a scene: batches, who sees which instances, and in which order."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import groupby
from typing import TypeAlias

import numpy as np

from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.refs import Ref
from elemental.gpu.resources import Buffer
from elemental.passes import scene_pack
from elemental.passes.culling import Culling
from elemental.passes.instance_table import InstanceTable
from elemental.passes.material_pack import ALL_SLOTS, CATEGORIES, SLOTS
from elemental.passes.material_textures import MaterialTextures
from elemental.passes.placed import Placed
from elemental.passes.scene_geometry import SceneGeometry
from elemental.passes.scene_pack import BLEND, OPAQUE, SOLID, Array, Batch
from elemental.passes.triangle_lists import TriangleLists
from elemental.passes.triangle_order import TriangleOrder
from elemental.passes.view_draws import CAMERA, OCCLUDERS, ViewDraws
from elemental.scene.model import AlphaMode, Scene

INSTANCE_FORMAT = "16f 16f 4u 64x/i"
INSTANCE_NAMES = ("a_world_from_local", "a_normal_from_local", "a_instance_words")
"""Members of struct Instance as attributes; the last holds its four words."""

RunKey: TypeAlias = tuple[tuple[AlphaMode, ...], bool | None, bool]
"""(alpha modes, dynamic, cull) of `draw_positions`."""
Run: TypeAlias = tuple[int, int, bool]
"""Draw commands that follow each other: (first, count, whether double-sided)."""


class SceneDraws:
    """The draws of a scene whose geometry, instances and textures a GpuScene holds.

    `in_view` is what the camera sees, `lists` what voxelization draws; `dynamic` (N,) bool tells
    which instances stand in batches of their own.
    """

    instances: Buffer
    geometry: SceneGeometry
    dynamic: Array
    _device: Device
    _scene: Scene
    _table: InstanceTable
    _textures: MaterialTextures
    _runs: dict[RunKey, list[Run]]

    def _upload(self, name: str, values: Array, dynamic: bool = False) -> Buffer:
        return self._device.buffer(f"scene.{name}", values, category="meshes", dynamic=dynamic)

    def _arrange(self) -> None:
        """Sort the instances into batches, with all that hangs on their order."""
        commands, numbers, self._batches = scene_pack.pack_draws(
            self._scene, self.geometry.packed, self.dynamic
        )
        self._textures.upload(self._batches)
        table = self._table
        self._culling = Culling(commands, numbers, table.low, table.high, table.visible)
        self._commands, self._order = commands, numbers
        self._runs = {}
        self._everything = self._place("everything")
        self._seen_by: dict[str, Placed] = {}
        solid = commands[: sum(batch.count for batch in self.batches(SOLID))]
        self.in_view = ViewDraws(self._device, table, self._everything, solid, self._place)
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
        self.in_view.release()
        self._listed.release()
        self._sorted.release()
        self.lists.release()

    def look(self, viewers: Sequence[str], clip_from_world: Array) -> None:
        """Leave out of the draws `seen_by` these viewers what they can't see by their matrices
        (V, 4, 4)."""
        for viewer, commands, order in self._culling.look(viewers, clip_from_world):
            if viewer not in self._seen_by:
                self._seen_by[viewer] = self._place(viewer)
            self._seen_by[viewer].commands.write(commands)
            self._seen_by[viewer].order.write(order)

    def _placed(self, viewer: str | None) -> Placed:
        if viewer == CAMERA:
            return self.in_view.visible
        if viewer == OCCLUDERS:
            return self.in_view.occluders
        return self._everything if viewer is None else self._seen_by[viewer]

    def uses(self, viewer: str) -> tuple[Buffer, Buffer]:
        """What a pass that draws what this viewer sees names in its ``uses``."""
        placed = self._placed(viewer)
        return placed.commands, placed.order

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
        materials; without it the pass's state stays. `seen_by`: a viewer given to `look`, or one
        of `in_view`.
        """
        placed = self._placed(seen_by)
        for batch in self.textured(encoder, batches, texture_mask):
            if cull:
                encoder.set(cull="none" if batch.double_sided else "back")
            encoder.draw_indirect(placed.vertices, placed.commands, batch.count, batch.first)

    def draw_sorted(self, encoder: Encoder, batches: Iterable[Batch]) -> None:
        """Draw batches of `back_to_front`, culling left as it is."""
        for batch in self.textured(encoder, batches):
            if batch.instance in self._sorted:
                self._sorted.draw(encoder, batch.instance)
            else:
                placed = self._everything
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

    def texture_reads(self, batch: Batch) -> dict[str, Ref]:
        """A batch's textures by their GLSL names, for a pass that is of it alone."""
        slots = zip(SLOTS, batch.textures, strict=True)
        reads: dict[str, Ref] = {
            f"u_{slot}_texture": self._textures.sampled(slot, number) for slot, number in slots
        }
        return reads | {f"u_{own.name}": self._textures.own(own) for own in batch.own_textures}

    def draw_positions(
        self,
        encoder: Encoder,
        alpha_modes: Collection[AlphaMode] = OPAQUE,
        *,
        dynamic: bool | None = None,
        seen_by: str | None = None,
        cull: bool = False,
    ) -> None:
        """Draw with the attributes a_position and a_instance only.

        `dynamic` as for `batches`, `seen_by` and `cull` as for `draw`.
        """
        placed = self._placed(seen_by)
        for first, count, double_sided in self._runs_of(alpha_modes, dynamic, cull):
            if cull:
                encoder.set(cull="none" if double_sided else "back")
            encoder.draw_indirect(placed.positions_only, placed.commands, count, first)

    def _runs_of(
        self, alpha_modes: Collection[AlphaMode], dynamic: bool | None, cull: bool
    ) -> list[Run]:
        key = tuple(alpha_modes), dynamic, cull
        if key not in self._runs:
            self._runs[key] = []
            for mode in CATEGORIES:
                batches = self.batches((mode,), dynamic) if mode in alpha_modes else []
                sides = groupby(batches, lambda batch: cull and batch.double_sided)
                for double_sided, drawn in sides:
                    run = list(drawn)
                    count = sum(batch.count for batch in run)
                    self._runs[key].append((run[0].first, count, double_sided))
        return self._runs[key]
