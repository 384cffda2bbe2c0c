"""Small copies of a scene's textures, for the panel to show."""

from __future__ import annotations

from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8
from elemental.gpu.resources import Texture
from elemental.scene.materials import Texture as Image

SIDE_PX = 128
"""Longest side of a copy."""


class Thumbnails:
    """Made when they are first asked for, and kept."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._made: dict[int, tuple[Image, Texture]] = {}

    def of(self, number: int, image: Image) -> Texture:
        """The copy of an image, which is the scene's texture of that number."""
        held = self._made.get(number)
        if held is not None and held[0] is image:
            return held[1]
        if held is not None:
            held[1].release()
        height, width = image.pixels.shape[:2]
        step = max(-(-max(width, height) // SIDE_PX), 1)
        texels = image.pixels[::step, ::step].copy()
        texels[..., 3] = 255
        size = (texels.shape[1], texels.shape[0])
        texture = self._device.texture(
            f"thumbnail.{number}", size, RGBA8, data=texels, category="targets"
        )
        self._made[number] = (image, texture)
        return texture

    def release(self) -> None:
        """Free all copies."""
        for _, texture in self._made.values():
            texture.release()
        self._made.clear()
