"""Punctual lights and the light from infinity."""

from __future__ import annotations

import math
import operator
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np

from elemental.core.errors import InputError
from elemental.scene.arrays import FloatArray
from elemental.scene.blackbody import COOLEST, HOTTEST, blackbody_color
from elemental.scene.ies import LightProfile

LightKind: TypeAlias = Literal["directional", "point", "spot"]


@dataclass(frozen=True, eq=False)
class LightMask:
    """A picture that a light shines through: ``pixels`` (H, W, 3) float32, the share of the light
    of each primary, row 0 on top."""

    name: str
    pixels: FloatArray
    file: Path | None = None
    """Where it was read from."""


@dataclass
class Light:
    """A punctual light (KHR_lights_punctual). One that changes is replaced, not written to.

    `intensity` is lux for a directional light, candela for the others; `position` and `direction`
    are (3,) float32, the direction a unit vector pointing away from the light; `range` in m; cone
    half angles in radians; `source_radius` in m, of a directional light the sun's angular radius in
    rad. A `node` of `Scene.motion`'s rig moves it.

    `color` is linear; that of a black body of `temperature` K multiplies it, with a luminance of 1.
    `intensity` is then the peak of the `profile`, whose plane at 0° is turned by `roll` rad about
    the direction: see `profile_axis`.

    A spot or directional light may shine through a `mask`, upright for who looks along the
    direction, and turned by `roll`. Of a spot it fills the outer cone; of a sun it repeats every
    `mask_size` m around `position`. `mask_scroll` are its widths and heights a second to the right
    and down, `mask_offset` where that has brought it.
    """

    name: str
    kind: LightKind
    color: FloatArray
    intensity: float
    position: FloatArray
    direction: FloatArray
    range: float = math.inf
    inner_angle: float = 0.0
    outer_angle: float = math.pi / 4
    source_radius: float = 0.0
    casts_shadow: bool = True
    node: int = -1
    temperature: float | None = None
    profile: LightProfile | None = None
    roll: float = 0.0
    mask: LightMask | None = None
    mask_size: float = 1.0
    mask_scroll: tuple[float, float] = (0.0, 0.0)
    mask_offset: tuple[float, float] = (0.0, 0.0)

    @property
    def strength(self) -> FloatArray:
        """(3,) float32 lux or candela of each primary."""
        strength = self.color * np.float32(self.intensity)
        if self.temperature is not None:
            strength = strength * blackbody_color(self.temperature)
        return strength

    @property
    def profile_axis(self) -> FloatArray:
        """(3,) float32 unit, across the direction: where the profile's plane at 0° lies, and the
        mask's right. Without a
        roll that is towards +x of a light that points straight down, else level and to the right
        of who looks along the direction. [inferred: no file says how a luminaire is hung]"""
        direction = self.direction.astype(np.float64)
        right = np.cross(direction, (0.0, 1.0, 0.0))
        length = float(np.linalg.norm(right))
        right = right / length if length > 1e-4 else np.array([1.0, 0.0, 0.0])
        up = np.cross(right, direction)
        axis = math.cos(self.roll) * right + math.sin(self.roll) * up
        return axis.astype(np.float32)


def same_objects(some: Sequence[object], others: Sequence[object]) -> bool:
    """Whether they are the very same, in the same order: a light that changes is replaced."""
    return len(some) == len(others) and all(map(operator.is_, some, others))


def checked(light: Light) -> Light:
    """The light itself. Raises InputError(its name, field, reason) for what can't be drawn."""
    numbers: dict[str, Any] = {
        "color": light.color, "intensity": light.intensity, "position": light.position,
        "direction": light.direction, "source_radius": light.source_radius, "roll": light.roll,
        "inner_angle": light.inner_angle, "outer_angle": light.outer_angle,
    }  # fmt: skip
    wrong = {name: "is not finite" for name, v in numbers.items() if not np.all(np.isfinite(v))}
    if np.any(light.color < 0.0):
        wrong.setdefault("color", "is negative")
    for name in ("intensity", "source_radius"):
        if getattr(light, name) < 0.0:
            wrong.setdefault(name, "is negative")
    if not light.range > 0.0:
        wrong.setdefault("range", "is not positive")
    if not np.linalg.norm(light.direction) > 0.0:
        wrong.setdefault("direction", "has length 0")
    if not 0.0 <= light.inner_angle <= light.outer_angle <= 0.5 * math.pi + 1e-6:
        wrong.setdefault("outer_angle", "is not between inner_angle and a right angle")
    if light.temperature is not None and not COOLEST <= light.temperature <= HOTTEST:
        wrong.setdefault("temperature", f"is not {COOLEST:g} to {HOTTEST:g} K")
    if light.mask is not None and light.kind == "point":
        wrong.setdefault("mask", "is for spot and directional lights")
    for field, reason in wrong.items():
        raise InputError(f"light {light.name!r}", field, reason)
    return light


@dataclass(frozen=True, eq=False)
class ImageSun:
    """The sun of an environment's image as a directional light of an untinted image, and the
    image's radiance (H, W, 3) float32 ``without`` it."""

    light: Light
    without: FloatArray


@dataclass
class Environment:
    """Light from infinity: `radiance` (H, W, 3) float32 equirectangular times tint and intensity.

    Direction (x, y, z) is at u = 1/2 + atan2(x, -z) / 2π, v = acos(y) / π, v downwards: row 0 is
    +y, the middle column -z. Without an image the radiance is 1 everywhere. The image holds its
    `sun` too, which `scene.image_sun` found there.
    """

    radiance: FloatArray | None
    tint: FloatArray
    intensity: float
    sun: ImageSun | None = None
