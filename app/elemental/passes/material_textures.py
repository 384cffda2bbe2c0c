"""The textures of a scene's materials on the device."""

from __future__ import annotations

from collections.abc import Collection

from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8, SRGB8_A8
from elemental.gpu.refs import Sampled
from elemental.gpu.resources import Texture, mip_count
from elemental.passes.material_pack import SLOTS, OwnTexture
from elemental.passes.scene_pack import Batch
from elemental.scene.model import Scene
from elemental.scene.model import Texture as Image
from elemental.scene.parameters import PLAIN_TEXTURES

SRGB_SLOTS = frozenset({"base_color", "emissive"})
ANISOTROPY = 4.0
"""Samples along the longer axis of a texture lookup's footprint. Software drivers go without: they
take twice as long for a textured G-buffer with it."""


class MaterialTextures:
    """The textures that a scene's materials name, each uploaded once for each transfer curve."""

    def __init__(self, device: Device, scene: Scene) -> None:
        self._device, self._scene = device, scene
        self._anisotropy = 1.0 if device.info.software else ANISOTROPY
        self._sampled: dict[tuple[bool, int], Sampled] = {}
        self._plain = {
            name: Sampled(_pixel(device, name, bytes(PLAIN_TEXTURES[name])))
            for name in ("white", "flat")
        }

    def upload(self, batches: Collection[Batch]) -> None:
        """Make the textures of some batches that are not there yet."""
        for batch in batches:
            for slot, number in zip(SLOTS, batch.textures, strict=True):
                key = (slot in SRGB_SLOTS, number)
                if number >= 0 and key not in self._sampled:
                    image = self._scene.textures[number]
                    self._sampled[key] = _upload(self._device, image, *key, self._anisotropy)
            for own in batch.own_textures:
                key = (own.is_srgb, own.number)
                if own.number >= 0 and key not in self._sampled:
                    image = self._scene.textures[own.number]
                    self._sampled[key] = _upload(self._device, image, *key, self._anisotropy)
                elif own.number < 0 and own.plain not in self._plain:
                    texel = bytes(PLAIN_TEXTURES[own.plain])
                    self._plain[own.plain] = Sampled(_pixel(self._device, own.plain, texel))

    def release(self) -> None:
        """Free the textures."""
        for sampled in (*self._plain.values(), *self._sampled.values()):
            assert isinstance(sampled.texture, Texture)
            sampled.texture.release()

    def sampled(self, slot: str, number: int) -> Sampled:
        """The texture to bind for a slot; -1 gives the neutral one."""
        if number < 0:
            return self._plain["flat" if slot == "normal" else "white"]
        return self._sampled[slot in SRGB_SLOTS, number]

    def own(self, texture: OwnTexture) -> Sampled:
        """The texture to bind for one of a definition's own."""
        if texture.number < 0:
            return self._plain[texture.plain]
        return self._sampled[texture.is_srgb, texture.number]


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
