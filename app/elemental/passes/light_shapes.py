"""Photometric profiles and masks of the lights as layers of one texture array."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from elemental.core.images import resized
from elemental.gpu.device import Device
from elemental.gpu.formats import R16F, RGBA16F
from elemental.gpu.refs import Ref, Sampled
from elemental.gpu.resources import Texture, mip_count
from elemental.scene.ies import LightProfile
from elemental.scene.lights import Light, LightMask

SIZE = (64, 256)
"""Texels of profiles round the axis and from pole to pole: 0.7 degrees a row, finer than files."""
MASK_SIZE = (256, 256)
"""Texels of a layer where any light has a mask [inferred: 4 mm of a window of a metre]."""

Shape: TypeAlias = LightProfile | LightMask


def shapes_of(lights: Sequence[Light]) -> list[Shape]:
    """Each profile and each mask that any of the lights has, once."""
    shapes = [shape for light in lights for shape in (light.profile, light.mask)]
    return list({id(shape): shape for shape in shapes if shape is not None}.values())


class LightShapes:
    """The texture `u_light_shapes` of lib/lights.glsl; `revision` counts its contents."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._held: list[Shape] = []
        self._texture: Texture | None = None
        self.revision = 0

    def update(self, shapes: Sequence[Shape]) -> None:
        """Hold these, uploaded anew where they are others than before."""
        same = len(shapes) == len(self._held)
        same &= all(a is b for a, b in zip(shapes, self._held, strict=False))
        if same and self._texture is not None:
            return
        self.release()
        self._held = list(shapes)
        self.revision += 1
        masks = any(isinstance(shape, LightMask) for shape in shapes)
        size = (MASK_SIZE if masks else SIZE) if shapes else (1, 1)
        texels = np.ones((max(len(shapes), 1), size[1], size[0], 4 if masks else 1), np.float16)
        for layer, shape in enumerate(shapes):
            texels[layer] = _layer(shape, size, texels.shape[-1])
        self._texture = self._device.texture(
            "lights.shapes",
            size,
            RGBA16F if masks else R16F,
            mips=mip_count(size) if masks else 1,
            layers=len(texels),
            data=texels,
        )

    def reads(self) -> dict[str, Ref]:
        """What lib/lights.glsl samples."""
        assert self._texture is not None, "update comes first"
        mips = self._texture.desc.mips
        sampled = Sampled(
            self._texture, filter="trilinear" if mips > 1 else "linear", wrap="repeat"
        )
        return {"u_light_shapes": sampled}

    def release(self) -> None:
        """Free the texture."""
        if self._texture is not None:
            self._texture.release()
            self._texture = None


def _layer(shape: Shape, size: tuple[int, int], channels: int) -> npt.NDArray[Any]:
    """(height, width, channels) of a profile, the same in all of them, or of a mask."""
    if isinstance(shape, LightProfile):
        return np.repeat(shape.image(*size)[..., None], channels, axis=2)
    pixels = resized(shape.pixels, *size)
    return np.concatenate([pixels, np.ones((*pixels.shape[:2], 1), np.float32)], axis=2)
