"""Decals: boxes that project a material onto what they hold."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from elemental.scene.arrays import FloatArray

DecalChannel: TypeAlias = Literal["color", "normal", "roughness", "emission"]
CHANNELS: tuple[DecalChannel, ...] = get_args(DecalChannel)


@dataclass
class Decal:
    """`Scene.materials[material]` projected along -z of a box.

    `world_from_decal` (4, 4) float32 takes the cube -1/2..1/2 to the box: x to the right and y up
    in the picture, z out of the surface that it is meant for. Boxes of a higher `order` cover those
    of a lower one. It fades out on surfaces turned from z by `fade_begin` to `fade_end` radians.
    Of the surface below it changes the `channels`.
    """

    name: str
    material: int
    world_from_decal: FloatArray
    opacity: float = 1.0
    order: int = 0
    fade_begin: float = np.radians(60.0)
    fade_end: float = np.radians(80.0)
    channels: tuple[DecalChannel, ...] = CHANNELS
