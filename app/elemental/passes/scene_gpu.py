"""The scene's meshes, materials and textures on the device, and how to draw them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import RGBA8, SRGB8_A8
from elemental.gpu.refs import Sampled
from elemental.gpu.resources import Buffer, Texture, VertexInput, mip_count
from elemental.passes import scene_pack
from elemental.passes.scene_pack import (
    ALL_SLOTS,
    BLEND,
    CATEGORIES,
    OPAQUE,
    SLOTS,
    Array,
    Batch,
)
from elemental.passes.triangle_lists import TriangleLists
from elemental.scene.area_lights import AreaLight
from elemental.scene.model import AlphaMode, Scene
from elemental.scene.model import Texture as Image

SRGB_SLOTS = frozenset({"base_color", "emissive"})
SURFACE_NAMES = scene_pack.SURFACE_VERTEX.names or ()
INSTANCE_NAMES = ("a_world_from_local", "a_normal_from_local", "a_instance_words")
"""Members of struct Instance as attributes; the last holds its four words."""
FLAT_NORMAL = bytes((128, 128, 255, 255))
WHITE = bytes((255, 255, 255, 255))
ANISOTROPY = 4.0
"""Samples along the longer axis of a texture lookup's footprint. Software drivers go without: they
take twice as long for a textured G-buffer with it."""


class GpuScene:
    """A scene's geometry, uploaded once: merged vertex and index buffers drawn indirectly.

    `instances` and `materials` are the storage blocks of glsl/shared. `version` counts the changes
    of geometry that cached shadow maps follow. `bounds` is the scene's (min, max) in m. `lists` is
    what voxelization draws; what `area_lights` emit is left out of the voxels.
    """

    def __init__(self, device: Device, scene: Scene, area_lights: Sequence[AreaLight] = ()) -> None:
        self.version = 0
        self.bounds = scene.bounds()
        self.triangle_count = scene.triangle_count
        geometry = scene_pack.pack_geometry(scene)
        commands, numbers, self._batches = scene_pack.pack_draws(scene, geometry)
        self._buffers: list[Buffer] = []

        def upload(name: str, values: Array) -> Buffer:
            self._buffers.append(device.buffer(f"scene.{name}", values, category="meshes"))
            return self._buffers[-1]

        self.instances = upload("instances", scene_pack.pack_instances(scene, area_lights))
        self.materials = upload("materials", scene_pack.pack_materials(scene))
        self.indices = indices = upload("indices", geometry.indices)
        self.positions = upload("positions", geometry.positions)
        position = (self.positions, "3f", ("a_position",))
        surface = (upload("surface", geometry.surface), "3f 4f 2f 2f 4f1", SURFACE_NAMES)

        def place(name: str) -> Placed:
            order = upload(f"order.{name}", numbers)
            instance = (order, "1u/i", ("a_instance",))
            return Placed(
                upload(f"draws.{name}", commands),
                order,
                device.vertex_input([position, surface, instance], indices),
                device.vertex_input([position, instance], indices),
            )

        self._place = place
        self._everything = place("everything")
        self._seen_by: dict[str, Placed] = {}
        self.lists = TriangleLists(device, commands, numbers, indices)
        placement = (self.instances, "16f 16f 4u/i", INSTANCE_NAMES)
        self._listed = device.vertex_input([position, surface, placement], self.lists.indices)
        self._culling = Culling(commands, numbers, *scene_pack.instance_boxes(scene))
        self._textures = MaterialTextures(device, scene, self._batches)

    def release(self) -> None:
        """Free everything."""
        for placed in (self._everything, *self._seen_by.values()):
            placed.vertices.release()
            placed.positions_only.release()
        self._listed.release()
        self.lists.release()
        self._textures.release()
        for buffer in self._buffers:
            buffer.release()

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
        self, alpha_modes: Collection[AlphaMode], textured: bool | None = None
    ) -> list[Batch]:
        """The batches of these alpha modes; `textured` keeps those with, or without, textures."""
        wanted = (True, False) if textured is None else (textured,)
        return [
            batch
            for batch in self._batches
            if batch.alpha_mode in alpha_modes and (batch.texture_mask != 0) in wanted
        ]

    def back_to_front(self, eye: Array) -> list[Batch]:
        """The blended batches, one an instance, by the distance of its centre to eye (3,)."""
        centers = self._culling.centers

        def distance(batch: Batch) -> float:
            return float(np.linalg.norm(centers[batch.instance] - eye))

        return sorted(self.batches(BLEND), key=distance, reverse=True)

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
        for batch in self._bind_textures(encoder, batches, texture_mask):
            if cull:
                encoder.set(cull="none" if batch.double_sided else "back")
            encoder.draw_indirect(placed.vertices, placed.commands, batch.count, batch.first)

    def draw_listed(
        self, encoder: Encoder, batches: Iterable[Batch], view: int, *, texture_mask: int
    ) -> None:
        """Draw what `lists` holds of the batches for a view, culling left as it is.

        The instance comes as the attributes INSTANCE_NAMES. The pass names the lists' commands and
        indices in ``uses``.
        """
        for batch in self._bind_textures(encoder, batches, texture_mask):
            instances = self._culling.instances_of(batch)
            first = self.lists.first_command(view) + instances.start
            encoder.draw_indirect(self._listed, self.lists.commands, len(instances), first)

    def _bind_textures(
        self, encoder: Encoder, batches: Iterable[Batch], texture_mask: int
    ) -> Iterator[Batch]:
        """Each batch, once its textures are bound."""
        bound: dict[str, int] = {}
        for batch in batches:
            for index, (slot, texture) in enumerate(zip(SLOTS, batch.textures, strict=True)):
                if texture_mask >> index & 1 and bound.get(slot) != texture:
                    encoder.bind(f"u_{slot}_texture", self._textures.sampled(slot, texture))
                    bound[slot] = texture
            yield batch

    def draw_positions(
        self,
        encoder: Encoder,
        alpha_modes: Collection[AlphaMode] = OPAQUE,
        *,
        seen_by: str | None = None,
    ) -> None:
        """Draw with the attributes a_position and a_instance only, culling left as it is."""
        placed = self._placed(seen_by)
        for mode in CATEGORIES:
            batches = self.batches((mode,)) if mode in alpha_modes else []
            if batches:
                count, first = sum(batch.count for batch in batches), batches[0].first
                encoder.draw_indirect(placed.positions_only, placed.commands, count, first)


@dataclass(frozen=True)
class Placed:
    """Draw commands, the instance numbers that they index, and the vertex inputs over both."""

    commands: Buffer
    order: Buffer
    vertices: VertexInput
    positions_only: VertexInput


class Culling:
    """Which instances a viewer sees, as draw commands with fewer instances each.

    commands (D,) DRAW_COMMAND, order (N,) instance numbers in draw order, low and high (N, 3) world
    boxes by instance number.
    """

    def __init__(self, commands: Array, order: Array, low: Array, high: Array) -> None:
        self._commands, self._order = commands, order
        self._segment = np.repeat(np.arange(len(commands)), commands["instance_count"])
        self.centers = (low + high) / 2
        self._half = (high - low) / 2
        self._looked: dict[str, bytes] = {}

    def look(self, viewer: str, clip_from_world: Array) -> tuple[Array, Array] | None:
        """(commands, order) by this matrix, None if the viewer's last look was by the same."""
        key = clip_from_world.tobytes()
        if key == self._looked.get(viewer):
            return None
        self._looked[viewer] = key
        seen = self.visible(clip_from_world)[self._order]
        commands = self._commands.copy()
        commands["instance_count"] = np.add.reduceat(seen, commands["base_instance"], dtype="<u4")
        return commands, self._order[np.lexsort((~seen, self._segment))]

    def instances_of(self, batch: Batch) -> range:
        """Where the batch's instances stand in draw order."""
        drawn = self._commands[batch.first : batch.first + batch.count]
        first = int(drawn["base_instance"][0])
        return range(first, first + int(drawn["instance_count"].sum()))

    def visible(self, clip_from_world: Array) -> Array:
        """(N,) bool: instances whose box is not wholly outside one of the frustum's planes."""
        m = clip_from_world.astype(np.float64)
        planes = np.concatenate([m[3] + m[:3], m[3] - m[:3]])
        reach = self._half @ np.abs(planes[:, :3]).T
        distance = self.centers @ planes[:, :3].T + planes[:, 3]
        return np.asarray(np.all(distance + reach >= 0.0, axis=1))


class MaterialTextures:
    """The textures that a scene's materials name, each uploaded once for each transfer curve."""

    def __init__(self, device: Device, scene: Scene, batches: Collection[Batch]) -> None:
        anisotropy = 1.0 if device.info.software else ANISOTROPY
        self._sampled: dict[tuple[bool, int], Sampled] = {}
        self._white = Sampled(_pixel(device, "white", WHITE))
        self._flat = Sampled(_pixel(device, "flat normal", FLAT_NORMAL))
        for batch in batches:
            for slot, number in zip(SLOTS, batch.textures, strict=True):
                key = (slot in SRGB_SLOTS, number)
                if number >= 0 and key not in self._sampled:
                    self._sampled[key] = _upload(device, scene.textures[number], *key, anisotropy)

    def release(self) -> None:
        """Free the textures."""
        for sampled in (self._white, self._flat, *self._sampled.values()):
            assert isinstance(sampled.texture, Texture)
            sampled.texture.release()

    def sampled(self, slot: str, number: int) -> Sampled:
        """The texture to bind for a slot; -1 gives the neutral one."""
        if number < 0:
            return self._flat if slot == "normal" else self._white
        return self._sampled[slot in SRGB_SLOTS, number]


def _upload(device: Device, image: Image, srgb: bool, number: int, anisotropy: float) -> Sampled:
    height, width = image.pixels.shape[:2]
    texture = device.texture(
        f"material.{number}.{image.name}",
        (width, height),
        SRGB8_A8 if srgb else RGBA8,
        mips=1 if image.nearest else mip_count((width, height)),
        data=image.pixels,
        category="textures",
    )
    wrap = (image.wrap_u, image.wrap_v)
    if image.nearest:
        return Sampled(texture, filter="nearest", wrap=wrap)
    return Sampled(texture, filter="trilinear", wrap=wrap, anisotropy=anisotropy)


def _pixel(device: Device, name: str, texel: bytes) -> Texture:
    return device.texture(f"material.{name}", (1, 1), RGBA8, data=texel, category="textures")
