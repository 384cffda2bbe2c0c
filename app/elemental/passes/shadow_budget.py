"""Which lights get shadow maps, and of what size. No GL here.

A sun has maps of the full size, the brightest first. Point and spot lights share what is left:
the more of the picture a light can reach, the larger its maps; where the budget is short all of
them get smaller, and at the smallest size those that reach least go without. A light keeps its
size until its reach in the picture has changed by more than rounding would.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from elemental.passes.scene_pack import Array
from elemental.passes.shadow_fit import ViewFrustum
from elemental.scene.lights import same_objects
from elemental.scene.model import Light

FACES = {"directional": 1, "spot": 1, "point": 6}
"""Maps of a light, but for a sun's cascades."""
HALVINGS = 3
"""Most times that the side of a local light's maps is halved."""
LEAST_SIDE = 64
"""Texels: below it a map's rim (shadow_fit.RIM_TEXELS) takes more than an eighth of it."""
OUT_OF_VIEW = 0.25
"""What the reach of a light counts that only what bounces can bring into the picture."""
LEVEL_MARGIN = 0.25
"""Octaves of the reach by which it must leave its level for another."""
ROOM_MARGIN = 0.8
"""Sizes grow again once this share of the room would do."""


@dataclass(frozen=True)
class Shares:
    """sides (L,): texels of each light's maps, 0 without; `unshadowed` lights should cast shadows
    and get no map; `layers` that no camera exceeds."""

    sides: list[int]
    unshadowed: int
    layers: int


class ShadowBudget:
    """Shares of `maps` full-sized ones of `resolution` texels a side; it knows its last choice."""

    def __init__(self, maps: int, resolution: int, cascades: int) -> None:
        self._maps, self._resolution, self._cascades = maps, resolution, cascades
        self._most = min(HALVINGS, max(int(math.log2(resolution / LEAST_SIDE)), 0))
        self._levels: Array = np.zeros(0, np.int64)
        self._shift = -64  # below any: the first choice asks for no margin
        self._lights: list[Light] = []
        self._shares: Shares | None = None

    def share(self, lights: Sequence[Light], spheres: Array, frustum: ViewFrustum) -> Shares:
        """spheres (L, 4): of `light_bounds`. Shares hold while the lights keep their levels."""
        if not same_objects(lights, self._lights):
            self._lights, self._shares = list(lights), None
        local = [n for n, light in enumerate(lights) if light.kind != "directional"]
        local = [number for number in local if lights[number].casts_shadow]
        last, levels = self._levels, self._level(reaches_of_picture(spheres[local], frustum))
        if self._shares is None or not np.array_equal(levels, last):
            self._shares = self._divide(lights, local, levels)
        return self._shares

    def _divide(self, lights: Sequence[Light], local: list[int], levels: Array) -> Shares:
        """local: numbers of the point and spot lights with shadows; levels: of these."""
        sides = [0] * len(lights)
        layers = 0
        suns = [n for n, light in enumerate(lights) if light.kind == "directional"]
        for number in sorted(suns, key=lambda n: -_strength(lights[n])):
            if lights[number].casts_shadow and layers + 1 + self._cascades <= self._maps:
                layers += 1 + self._cascades
                sides[number] = self._resolution
        faces = np.array([FACES[lights[number].kind] for number in local], np.int64)
        room = self._maps - layers
        halvings = self._halve(levels, faces, room)
        shown = _fitting(halvings, levels, faces, room)
        for number, halving, fits in zip(local, halvings, shown, strict=True):
            sides[number] = self._resolution >> int(halving) if fits else 0
        unshadowed = sum(
            light.casts_shadow and not side for light, side in zip(lights, sides, strict=True)
        )
        return Shares(sides, unshadowed, layers + min(room, int(faces.sum())))

    def _level(self, reaches: Array) -> Array:
        """(L,) how often the picture's height can be halved until it is a light's reach."""
        octaves = -np.log2(reaches)
        levels = np.floor(octaves).astype(np.int64)
        if len(self._levels) == len(levels):
            away = octaves - self._levels
            stays = (away >= -LEVEL_MARGIN) & (away < 1.0 + LEVEL_MARGIN)
            levels = np.where(stays, self._levels, levels)
        self._levels = levels
        return levels

    def _halve(self, levels: Array, faces: Array, room: int) -> Array:
        """(L,) how often the side of each light's maps is halved: the fewest that the room allows,
        the same for all lights on one level."""
        shifts = np.arange(-int(levels.max(initial=0)), self._most + 1)
        halvings = np.clip(levels + shifts[:, None], 0, self._most)
        margin = np.where(shifts >= self._shift, 1.0, ROOM_MARGIN)
        fits = _areas(halvings, faces).sum(axis=1) <= margin * room
        fits[-1] = True
        first = int(fits.argmax())
        self._shift = int(shifts[first])
        return np.asarray(halvings[first])


def reaches_of_picture(spheres: Array, frustum: ViewFrustum) -> Array:
    """(L,) radius of what each light reaches over half the picture's height there, at most 1."""
    offset = spheres[:, :3] - frustum.eye
    depth = np.maximum(offset @ frustum.forward, 1e-6)
    distance = np.linalg.norm(offset, axis=1)
    radius = np.where(spheres[:, 3] < 0.0, np.inf, np.maximum(spheres[:, 3], 1e-6))
    reach = np.minimum(radius / np.maximum(distance * frustum.tangent, 1e-6), 1.0)
    # The circle around the picture's corners, seen as a cone: outside of it nothing is in view.
    aside = np.sqrt(np.maximum(distance**2 - depth**2, 0.0)) - depth * frustum.corner_tangent
    out_of_view = (distance > radius) & (aside > radius * math.hypot(1.0, frustum.corner_tangent))
    return np.asarray(np.where(out_of_view, reach * OUT_OF_VIEW, reach))


def _strength(light: Light) -> float:
    return float(light.strength.max())


def _areas(halvings: Array, faces: Array) -> Array:
    """Of each light's maps, in maps of the full size."""
    return np.asarray(faces / 4.0**halvings)


def _fitting(halvings: Array, levels: Array, faces: Array, room: int) -> Array:
    """(L,) bool: those that fit, on the lowest levels first, then by number."""
    order = np.lexsort((np.arange(len(levels)), levels))
    area = np.cumsum(_areas(halvings, faces)[order])
    fits = np.zeros(len(levels), np.bool_)
    fits[order[area <= room]] = True
    return fits
