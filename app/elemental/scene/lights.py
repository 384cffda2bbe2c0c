"""Punctual lights and the light from infinity."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

from elemental.scene.arrays import FloatArray

LightKind: TypeAlias = Literal["directional", "point", "spot"]


@dataclass
class Light:
    """A punctual light (KHR_lights_punctual).

    `intensity` is lux for a directional light, candela for the others; `position` and `direction`
    are (3,) float32, the direction a unit vector pointing away from the light; `range` in m; cone
    half angles in radians; `source_radius` in m. A `node` of `Scene.motion`'s rig moves it.
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


@dataclass
class Environment:
    """Light from infinity: `radiance` (H, W, 3) float32 equirectangular times tint and intensity.

    Direction (x, y, z) is at u = 1/2 + atan2(x, -z) / 2π, v = acos(y) / π, v downwards: row 0 is
    +y, the middle column -z. Without an image the radiance is 1 everywhere.
    """

    radiance: FloatArray | None
    tint: FloatArray
    intensity: float
