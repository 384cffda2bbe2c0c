"""Post-process volumes: boxes and spheres that override settings for an eye in or near them.

[Mittring12 "Post Processing"]: "linearly blends post process properties; priority depending on
camera position; soft transitions with blend radius; weight can be controlled remotely".
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

from elemental.core.transforms import Vec3Like
from elemental.settings import SETTINGS, Settings

Vector = tuple[float, float, float]
Rows = tuple[Vector, Vector, Vector]

BLENDED_KINDS = frozenset({"float", "int", "color"})
"""Kinds of settings that have values between two values."""

# What a volume without a word about it has.
PRIORITY = 0.0
BLEND_RADIUS_M = 1.0
BLEND_WEIGHT = 1.0
SIZE_M = (1.0, 1.0, 1.0)
RADIUS_M = 1.0


@dataclass(frozen=True)
class Volume:
    """One volume; ``overrides`` are flat settings keys with checked values.

    A ``box`` has edges of ``size`` m, a ``sphere`` has ``radius`` m. ``rotation_deg`` turns about
    the x, then the y, then the z axis. The weight falls linearly to 0 over ``blend_radius`` m
    outside. An ``unbound`` volume acts everywhere.
    """

    name: str
    shape: Literal["box", "sphere"] = "box"
    center: Vector = (0.0, 0.0, 0.0)
    rotation_deg: Vector = (0.0, 0.0, 0.0)
    size: Vector = SIZE_M
    radius: float = RADIUS_M
    priority: float = PRIORITY
    blend_radius: float = BLEND_RADIUS_M
    blend_weight: float = BLEND_WEIGHT
    enabled: bool = True
    unbound: bool = False
    overrides: Mapping[str, Any] = field(default_factory=dict)

    @property
    def acts(self) -> bool:
        """Whether any eye sees its values."""
        return self.enabled and self.blend_weight > 0.0

    @cached_property
    def _axes(self) -> tuple[tuple[float, Vector], ...]:
        """(half of the size, direction in the world) of each axis."""
        x, y, z = rotation_rows(self.rotation_deg)
        return tuple((0.5 * size, (x[k], y[k], z[k])) for k, size in enumerate(self.size))

    def distance(self, point_ws: Vector) -> float:
        """Metres from a point to the volume, 0 inside."""
        x, y, z = point_ws
        cx, cy, cz = self.center
        x, y, z = x - cx, y - cy, z - cz
        if self.shape == "sphere":
            return max(math.sqrt(x * x + y * y + z * z) - self.radius, 0.0)
        outside = 0.0
        for half, (ax, ay, az) in self._axes:
            beyond = abs(ax * x + ay * y + az * z) - half
            if beyond > 0.0:
                outside += beyond * beyond
        return math.sqrt(outside)

    def weight(self, eye_ws: Vector) -> float:
        """Share of the volume's values, 0 to 1, as seen from an eye."""
        if not self.acts:
            return 0.0
        if self.unbound:
            return self.blend_weight
        distance = self.distance(eye_ws)
        if distance <= 0.0:
            return self.blend_weight
        if distance >= self.blend_radius:
            return 0.0
        return self.blend_weight * (1.0 - distance / self.blend_radius)


def rotation_rows(degrees: Vector) -> Rows:
    """Rows of the matrix that turns about the x, then the y, then the z axis."""
    x, y, z = (math.radians(angle) for angle in degrees)
    sx, sy, sz = math.sin(x), math.sin(y), math.sin(z)
    cx, cy, cz = math.cos(x), math.cos(y), math.cos(z)
    return (
        (cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx),
        (sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx),
        (-sy, cy * sx, cy * cx),
    )


def blend(base: Settings, volumes: Sequence[Volume], eye_ws: Vec3Like) -> Settings:
    """The settings of a frame: ``base``, and over it the volumes by rising priority.

    Volumes of one priority follow each other as in the file. Each moves every setting that it
    overrides towards its own value by its weight: numbers linearly, colours by component. Switches,
    choices and texts have no values between: the one with the largest share of the same sum is
    taken, of equal shares the later; ``Settings.mix`` tells the shares.
    """
    if not volumes:
        return base
    x, y, z = eye_ws
    eye = float(x), float(y), float(z)
    acting = [(v.priority, w, v) for v in volumes if v.overrides and (w := v.weight(eye)) > 0.0]
    if not acting:
        return base
    acting.sort(key=_priority)
    numbers: dict[str, Any] = {}
    mixes: dict[str, dict[Any, float]] = {}
    for _, weight, volume in acting:
        for key, value in volume.overrides.items():
            if SETTINGS[key].kind in BLENDED_KINDS:
                below = numbers[key] if key in numbers else base[key]
                numbers[key] = _between(below, value, weight)
            else:
                shares = mixes.setdefault(key, {base[key]: 1.0})
                for known in shares:
                    shares[known] *= 1.0 - weight
                shares[value] = shares.pop(value, 0.0) + weight  # the latest stands last
    for key, number in numbers.items():
        if SETTINGS[key].kind == "int":
            numbers[key] = math.floor(number + 0.5)
    return base.blended(numbers, {key: tuple(shares.items()) for key, shares in mixes.items()})


def _priority(acting: tuple[float, float, Volume]) -> float:
    return acting[0]


def _between(below: Any, above: Any, weight: float) -> Any:
    """From ``below`` (weight 0) to ``above`` (weight 1), never outside of the two."""
    if isinstance(above, tuple):
        return tuple(_between(b, a, weight) for b, a in zip(below, above, strict=True))
    low, high = (below, above) if below <= above else (above, below)
    return min(max(below * (1.0 - weight) + above * weight, low), high)
