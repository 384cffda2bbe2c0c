"""Pictures that lights shine through (gobos, cookies): light functions of a spot or a sun."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from elemental.core.images import read_png_jpeg_webp
from elemental.core.srgb import decode_srgb
from elemental.scene.lights import Light, LightMask


def read_light_mask(path: Path) -> LightMask:
    """A PNG, JPEG or WebP file; its sRGB colours times its opacity let light through.

    Raises InputError.
    """
    codes = read_png_jpeg_webp(path).astype(np.float32) / np.float32(255.0)
    return LightMask(path.name, decode_srgb(codes[..., :3]) * codes[..., 3:], path)


def masked(light: Light, mask: LightMask | None) -> Light:
    """The light through another mask; without one, its size, drift and roll are the defaults."""
    if mask is not None:
        return replace(light, mask=mask)
    roll = light.roll if light.profile is not None else 0.0
    return replace(
        light, mask=None, mask_size=Light.mask_size, mask_scroll=Light.mask_scroll, roll=roll
    )


@dataclass
class MaskDrift:
    """Moves the masks that scroll; the very lights of before while they and the time stand."""

    _lights: Sequence[Light] = ()
    _time_s: float = 0.0
    _drifted: list[Light] | None = None

    def at(self, lights: Sequence[Light], time_s: float) -> Sequence[Light]:
        """The lights at a time, s; they themselves where no mask scrolls."""
        if not any(light.mask is not None and any(light.mask_scroll) for light in lights):
            return lights
        same = len(lights) == len(self._lights) and all(map(_is, lights, self._lights))
        if self._drifted is None or time_s != self._time_s or not same:
            self._lights, self._time_s = list(lights), time_s
            self._drifted = [drifted(light, time_s) for light in lights]
        return self._drifted


def _is(one: Light, other: Light) -> bool:
    return one is other


def drifted(light: Light, time_s: float) -> Light:
    """The light with its mask where it has scrolled to."""
    if light.mask is None or not any(light.mask_scroll):
        return light
    u, v = (speed * time_s % 1.0 for speed in light.mask_scroll)
    return replace(light, mask_offset=(u, v))
