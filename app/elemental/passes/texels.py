"""A texture's texels on the CPU, as shaders read them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.gpu.formats import Format
from elemental.gpu.resources import Texture

Pixels = npt.NDArray[Any]


def texels(texture: Texture, level: int, layer: int) -> Pixels:
    """One layer of one level, (H, W, C) float32, row 0 on top. Waits for the GPU."""
    pixels = texture.read(level)
    has_layers = pixels.ndim > (3 if texture.format.channels > 1 else 2)
    if has_layers:
        pixels = pixels[layer]
    return np.flipud(_decoded(pixels, texture.format))


def _decoded(pixels: Pixels, fmt: Format) -> Pixels:
    if fmt.name == "RGB10_A2":
        parts = [(pixels >> shift) & 1023 for shift in (0, 10, 20)]
        opacity = (pixels >> 30).astype(np.float32) / 3
        return np.stack([*(p.astype(np.float32) / 1023 for p in parts), opacity], axis=-1)
    if fmt.name == "D24S8":
        return ((pixels >> 8).astype(np.float64) / (2**24 - 1)).astype(np.float32)[..., None]
    values = pixels.astype(np.float32)
    if fmt.kind != "uint" and np.issubdtype(pixels.dtype, np.integer):
        values = np.maximum(values / np.float32(np.iinfo(pixels.dtype).max), -1.0)
    return values if values.ndim == 3 else values[..., None]
