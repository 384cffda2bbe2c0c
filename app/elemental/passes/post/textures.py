"""Look-up tables and masks that settings name, loaded when they are first asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np

from elemental.core.cube_lut import CubeLut, read_cube_lut
from elemental.core.errors import InputError
from elemental.core.images import read_lens_texture
from elemental.core.paths import named_file
from elemental.core.srgb import decode_srgb
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA16F, SRGB8_A8
from elemental.gpu.resources import Texture, mip_count
from elemental.settings import Settings

MOST_LUTS = 2
"""Tables that one picture is graded by."""
MOST_CURVE_TEXELS = 4096
"""Longer curves are resampled to this: drivers of GL 4.3 have textures of 16,384 at least, displays
tell 1,024 levels apart."""
HALF_MAX = 65504.0

T = TypeVar("T")


@dataclass(frozen=True)
class Lut:
    """A look-up table on the device."""

    table: CubeLut
    texture: Texture


@dataclass(frozen=True)
class Mask:
    """An image on the device, linear when sampled, with mips; ``mean`` of its levels, 0..1."""

    texture: Texture
    mean: float


class PostTextures:
    """What is loaded, by the name that a setting gives: a file in ``folder`` or content/textures/.

    ``problems``: names that could not be loaded, and why. What the setting named before stays then;
    where it named nothing, the effect goes without.
    """

    def __init__(self, device: Device, folder: Path) -> None:
        self._device, self._folder = device, folder
        self._luts: dict[str, Lut] = {}
        self._masks: dict[str, Mask] = {}
        self._last_name: dict[str, str] = {}
        self.problems: dict[str, InputError] = {}

    def lut(self, name: str) -> Lut | None:
        """The table of a `.cube` file; None for an empty name."""
        return self._get("color_grading.lut", self._luts, name, self._load_lut)

    def grading(self, s: Settings) -> list[tuple[Lut, float]]:
        """The tables that grade the picture, two at most, each with its share of it.

        While volumes blend several, the two of the largest shares count by those, none by its
        own: the picture as it is takes the rest.
        """
        intensity = s["color_grading.intensity"]
        if intensity <= 0.0:
            return []
        named = [(name, share) for name, share in s.mix("color_grading.lut") if name and share > 0]
        named.sort(key=lambda part: -part[1])
        found = [(self.lut(name), intensity * share) for name, share in named[:MOST_LUTS]]
        return [(lut, share) for lut, share in found if lut is not None]

    def mask(self, key: str, name: str) -> Mask | None:
        """A PNG, JPEG or WebP image that the setting ``key`` names; None for an empty name."""
        return self._get(key, self._masks, name, self._load_mask)

    def release(self) -> None:
        """Free everything."""
        for lut in self._luts.values():
            lut.texture.release()
        for mask in self._masks.values():
            mask.texture.release()

    def _get(self, key: str, known: dict[str, T], name: str, load: Callable[[Path], T]) -> T | None:
        if not name:
            return None
        if name not in known and name not in self.problems:
            try:
                known[name] = load(named_file(name, self._folder))
            except InputError as error:
                self.problems[name] = InputError(key, name, error.reason)
        if name in known:
            self._last_name[key] = name
        return known.get(self._last_name.get(key, ""))

    def _load_lut(self, path: Path) -> Lut:
        lut = read_cube_lut(path)
        colors = np.clip(lut.table, -HALF_MAX, HALF_MAX)
        if not lut.is_cube and lut.size > MOST_CURVE_TEXELS:
            places = np.linspace(0, lut.size - 1, MOST_CURVE_TEXELS)
            old = np.arange(lut.size)
            colors = np.stack([np.interp(places, old, colors[:, k]) for k in range(3)], axis=1)
            lut = CubeLut(colors.astype(np.float32), lut.low, lut.high)
        texels = np.ones((*colors.shape[:-1], 4), np.float16)
        texels[..., :3] = colors
        size = (lut.size,) * 3 if lut.is_cube else (lut.size, 1)
        return Lut(lut, self._device.texture(path.name, size, RGBA16F, data=texels))

    def _load_mask(self, path: Path) -> Mask:
        pixels = np.ascontiguousarray(np.flipud(read_lens_texture(path)))
        height, width = pixels.shape[:2]
        levels = mip_count((width, height))
        texture = self._device.texture(
            path.name, (width, height), SRGB8_A8, mips=levels, data=pixels
        )
        codes = pixels[..., :3].astype(np.float32) / np.float32(255.0)
        return Mask(texture, float(decode_srgb(codes).mean(dtype=np.float64)))
