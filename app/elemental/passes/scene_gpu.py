"""The scene's meshes, materials and textures on the device, and how to draw them."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import RGBA8, SRGB8_A8
from elemental.gpu.refs import Sampled
from elemental.gpu.resources import Buffer, Texture, mip_count
from elemental.passes import scene_pack
from elemental.passes.scene_pack import BLEND, CATEGORIES, OPAQUE, SLOTS, Array, Batch
from elemental.scene.model import AlphaMode, Scene
from elemental.scene.model import Texture as Image

SRGB_SLOTS = frozenset({"base_color", "emissive"})
SURFACE_NAMES = scene_pack.SURFACE_VERTEX.names or ()
FLAT_NORMAL = bytes((128, 128, 255, 255))
WHITE = bytes((255, 255, 255, 255))
ANISOTROPY = 4.0
"""Samples along the longer axis of a texture lookup's footprint. Software drivers go without: with
it llvmpipe draws the textured G-buffer a thousand times slower (FlightHelmet, 640x360: 41 s)."""


class GpuScene:
    """A scene's geometry, uploaded once: merged vertex and index buffers drawn indirectly.

    `instances` and `materials` are the storage blocks of glsl/shared. `version` counts the changes
    of geometry that cached shadow maps follow. `bounds` is the scene's (min, max) in m.
    """

    def __init__(self, device: Device, scene: Scene) -> None:
        self.version = 0
        self.bounds = scene.bounds()
        self.triangle_count = scene.triangle_count
        geometry = scene_pack.pack_geometry(scene)
        commands, numbers, self._batches = scene_pack.pack_draws(scene, geometry)

        self._buffers: list[Buffer] = []

        def upload(name: str, values: Array) -> Buffer:
            self._buffers.append(device.buffer(f"scene.{name}", values, category="meshes"))
            return self._buffers[-1]

        self.instances = upload("instances", scene_pack.pack_instances(scene))
        self.materials = upload("materials", scene_pack.pack_materials(scene))
        self._commands = upload("draws", commands)
        indices = upload("indices", geometry.indices)
        position = (upload("positions", geometry.positions), "3f", ("a_position",))
        instance = (upload("draw_order", numbers), "1u/i", ("a_instance",))
        surface = (upload("surface", geometry.surface), "3f 4f 2f 2f 4f1", SURFACE_NAMES)
        self._positions_only = device.vertex_input([position, instance], indices)
        self._vertices = device.vertex_input([position, surface, instance], indices)
        self._textures = MaterialTextures(device, scene, self._batches)
        self._centers = {
            batch.instance: scene_pack.instance_center(scene, batch.instance)
            for batch in self.batches(BLEND)
        }

    def release(self) -> None:
        """Free everything."""
        for held in (self._positions_only, self._vertices, self._textures, *self._buffers):
            held.release()

    def batches(
        self, alpha_modes: Collection[AlphaMode], textured: bool | None = None
    ) -> list[Batch]:
        """The batches of these alpha modes; `textured` keeps those with, or without, textures."""
        return [b for b in self._batches
                if b.alpha_mode in alpha_modes and textured in (None, b.textured)]  # fmt: skip

    def draw(
        self,
        encoder: Encoder,
        alpha_modes: Collection[AlphaMode] = OPAQUE,
        *,
        textured: bool | None = None,
        cull: bool = True,
        eye: Array | None = None,
    ) -> None:
        """Draw with every attribute and, unless `textured` is False, the material textures bound.

        `cull` hides the back faces of single-sided materials; without it the pass's state stays.
        `eye` (3,): blended instances are drawn in the order of their centres, the farthest first.
        """
        batches = self.batches(alpha_modes, textured)
        if eye is not None:
            batches.sort(key=lambda b: -float(np.linalg.norm(self._centers[b.instance] - eye)))
        for batch in batches:
            if cull:
                encoder.set(cull="none" if batch.double_sided else "back")
            if textured is not False:
                for slot, texture in zip(SLOTS, batch.textures, strict=True):
                    encoder.bind(f"u_{slot}_texture", self._textures.sampled(slot, texture))
            encoder.draw_indirect(self._vertices, self._commands, batch.count, batch.first)

    def draw_positions(self, encoder: Encoder, alpha_modes: Collection[AlphaMode] = OPAQUE) -> None:
        """Draw with the attributes a_position and a_instance only, culling left as it is."""
        for mode in CATEGORIES:
            batches = self.batches((mode,)) if mode in alpha_modes else []
            if batches:
                count = sum(batch.count for batch in batches)
                encoder.draw_indirect(self._positions_only, self._commands, count, batches[0].first)


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
