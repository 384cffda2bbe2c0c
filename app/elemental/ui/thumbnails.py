"""Small copies of a scene's images, for the panel to show."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core.srgb import encode_srgb
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8
from elemental.gpu.resources import Texture
from elemental.scene.lights import LightMask
from elemental.ui.images import Picture

SIDE_PX = 128
"""Longest side of a copy."""


class Thumbnails:
    """Made when they are first asked for, and kept."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._made: dict[Hashable, tuple[Picture, Texture]] = {}

    def of(self, key: Hashable, image: Picture) -> Texture:
        """The copy of an image, held under a key, where it takes the place of another."""
        held = self._made.get(key)
        if held is not None and held[0] is image:
            return held[1]
        if held is not None:
            held[1].release()
        texels = _texels(image)
        size = (texels.shape[1], texels.shape[0])
        texture = self._device.texture(
            f"thumbnail.{key}", size, RGBA8, data=texels, category="targets"
        )
        self._made[key] = (image, texture)
        return texture

    def release(self) -> None:
        """Free all copies."""
        for _, texture in self._made.values():
            texture.release()
        self._made.clear()


def _texels(image: Picture) -> npt.NDArray[Any]:
    """(H, W, 4) uint8, as large as a copy is."""
    height, width = image.pixels.shape[:2]
    step = max(-(-max(width, height) // SIDE_PX), 1)
    few: npt.NDArray[Any] = image.pixels[::step, ::step, :3]
    if isinstance(image, LightMask):
        few = np.round(255.0 * encode_srgb(few)).astype(np.uint8)
    return np.concatenate([few, np.full_like(few[..., :1], 255)], axis=2)
