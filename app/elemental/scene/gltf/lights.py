"""KHR_lights_punctual: directional, point and spot lights."""

from __future__ import annotations

import math

import numpy as np

from elemental.scene.gltf.fields import Field
from elemental.scene.model import FloatArray, Light, LightKind
from elemental.scene.placement import forward

EXTENSION = "KHR_lights_punctual"
KINDS: dict[str, LightKind] = {"directional": "directional", "point": "point", "spot": "spot"}
DEFAULT_OUTER_ANGLE = math.pi / 4


def declared_lights(root: Field) -> list[Field]:
    extension = root.extension(EXTENSION)
    return extension.elements("lights") if extension else []


def place_light(field: Field, name: str, world_from_local: FloatArray) -> Light:
    """The light at a node: it shines along the node's -z; the node's scale is ignored."""
    field.need("type")
    kind = field.choice_or("type", KINDS["point"], KINDS)
    color = field.find("color")
    reach = field.number_or("range", 0.0, 0.0)
    spot = field.need("spot") if kind == "spot" else None
    inner, outer = _cone(spot) if spot else (0.0, DEFAULT_OUTER_ANGLE)
    return Light(
        name=name,
        kind=kind,
        color=color.numbers(3, 0.0) if color else np.ones(3, np.float32),
        intensity=field.number_or("intensity", 1.0, 0.0),
        position=world_from_local[:3, 3].copy(),
        direction=forward(world_from_local),
        range=reach or math.inf,  # some exporters write 0 for "no limit"
        inner_angle=inner,
        outer_angle=outer,
    )


def _cone(spot: Field) -> tuple[float, float]:
    """(inner, outer) half angles in radians."""
    outer = spot.number_or("outerConeAngle", DEFAULT_OUTER_ANGLE, 0.0, math.pi)
    inner = spot.number_or("innerConeAngle", 0.0, 0.0, math.pi)
    if outer == 0.0:
        raise spot.error("outerConeAngle is 0")
    if outer > math.pi / 2:
        spot.warn("outerConeAngle is clamped to a right angle")
        outer = math.pi / 2
    if inner >= outer:
        spot.warn("innerConeAngle is not below outerConeAngle and is lowered to it")
    return min(inner, outer), outer
