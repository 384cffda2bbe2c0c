"""Where everything in the atrium stands.

The plan is a grid of square bays, BAY metres wide: a court of 6 x 3 bays inside a gallery one bay
deep, two storeys high, open to the sky. The column lines lie at x = +-HALF_X and z = +-HALF_Z.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

BAY = 2.8
BAYS_X, BAYS_Z = 6, 3
HALF_X, HALF_Z = BAYS_X * BAY / 2.0, BAYS_Z * BAY / 2.0

GALLERY = 0.16  # floor of the ground gallery, one step over the court
SPRING = 2.75  # springing of the ground arches and vaults
SLAB = 4.4  # top of the vaults
LOGGIA = 4.6  # floor of the upper storey
LOGGIA_SPRING = 6.95
EAVES = 8.1

BEAM_SPACING = 0.72

QUARTER = np.pi / 2.0


@dataclass(frozen=True)
class Place:
    """One copy of a prototype: metres, yaw about y in radians."""

    prototype: str
    x: float
    y: float
    z: float
    yaw: float = 0.0
    scale: float = 1.0


def _runs(step: float, offset: float = 0.0) -> Iterator[tuple[float, float, float, int]]:
    """(x, z, yaw, number) along the four column lines; local +z looks into the court."""
    for z, yaw in ((-HALF_Z, 0.0), (HALF_Z, 2.0 * QUARTER)):
        count = round(2.0 * HALF_X / step)
        for k in range(count):
            yield -HALF_X + (k + offset) * step, z, yaw, k
    for x, yaw in ((-HALF_X, QUARTER), (HALF_X, 3.0 * QUARTER)):
        count = round(2.0 * HALF_Z / step)
        for k in range(count):
            yield x, -HALF_Z + (k + offset) * step, yaw, k


def _lattice(step: float) -> Iterator[tuple[float, float]]:
    """Every column's (x, z) once, the corners included."""
    nx, nz = round(2.0 * HALF_X / step), round(2.0 * HALF_Z / step)
    for k in range(nx + 1):
        yield -HALF_X + k * step, -HALF_Z
        yield -HALF_X + k * step, HALF_Z
    for k in range(1, nz):
        yield -HALF_X, -HALF_Z + k * step
        yield HALF_X, -HALF_Z + k * step


def _architecture() -> Iterator[Place]:
    for x, z in _lattice(BAY):
        yield Place("ground_column", x, GALLERY, z)
    for x, z in _lattice(BAY / 2.0):
        yield Place("loggia_column", x, LOGGIA, z)
    for x, z, yaw, _ in _runs(BAY, 0.5):
        yield Place("ground_arch", x, SPRING, z, yaw)
    for x, z, yaw, _ in _runs(BAY / 2.0, 0.5):
        yield Place("loggia_arch", x, LOGGIA_SPRING, z, yaw)
        yield Place("balustrade", x, LOGGIA, z, yaw)
        yield Place("dentils", x, EAVES, z, yaw)
    for sx, sz in product((-1, 1), repeat=2):
        yield Place("corner_piers", sx * HALF_X, 0.0, sz * HALF_Z)


def _ceilings() -> Iterator[Place]:
    outer_x, outer_z = HALF_X + BAY / 2.0, HALF_Z + BAY / 2.0
    for k, z in product(range(BAYS_X + 2), (-outer_z, outer_z)):
        yield Place("vault", -outer_x + k * BAY, SPRING, z)
    for k, x in product(range(BAYS_Z), (-outer_x, outer_x)):
        yield Place("vault", x, SPRING, -HALF_Z + (k + 0.5) * BAY)
    for k, side in product(range(BAYS_X + 1), (-1, 1)):
        x = -HALF_X + k * BAY
        yield Place("rib", x, SPRING, side * outer_z, QUARTER)
        yield Place("corbel", x, SPRING, side * (HALF_Z + BAY), -side * QUARTER)
    for k, side in product(range(BAYS_Z + 1), (-1, 1)):
        z = -HALF_Z + k * BAY
        yield Place("rib", side * outer_x, SPRING, z)
        yield Place("corbel", side * (HALF_X + BAY), SPRING, z, (1 - side) * QUARTER)
    for k, z in product(range(-15, 16), (-outer_z, outer_z)):
        yield Place("beam", k * BEAM_SPACING, EAVES, z)
    for k, x in product(range(-5, 6), (-outer_x, outer_x)):
        yield Place("beam", x, EAVES, k * BEAM_SPACING, QUARTER)


COLORS = ("red", "green", "blue")


def _cloth() -> Iterator[Place]:
    curtains = (
        *((-1, 0, "red"), (-1, 2, "blue"), (-1, 3, "green"), (-1, 5, "red")),
        *((1, 1, "green"), (1, 4, "blue")),
    )
    for side, bay, color in curtains:
        x, yaw = -HALF_X + (bay + 0.5) * BAY, (1 + side) * QUARTER
        yield Place(f"curtain_{color}", x, SPRING - 0.17, side * HALF_Z, yaw)
    for k, side in product(range(3), (-1, 1)):
        color = COLORS[(k + (1 - side) // 2) % 3]
        z, yaw = side * (HALF_Z - 0.52), (1 + side) * QUARTER
        yield Place(f"banner_{color}", 2 * (k - 1) * BAY, EAVES - 0.08, z, yaw)
    for side, color in ((-1, "blue"), (1, "green")):
        yield Place(f"banner_{color}", side * (HALF_X - 0.52), EAVES - 0.08, 0.0, -side * QUARTER)


def _props() -> Iterator[Place]:
    yield Place("forge", 0.0, 0.0, 0.0)
    for x, z, scale, yaw in (
        (-7.3, -3.1, 1.0, 0.3),
        (-7.3, 3.1, 0.92, 1.9),
        (7.3, -3.1, 0.95, 4.0),
        (7.3, 3.1, 1.05, 5.1),
        (-3.6, -3.2, 0.8, 2.6),
        (3.6, 3.2, 0.8, 3.4),
    ):
        yield Place("planter", x, 0.0, z, yaw, scale)
    outer_x, outer_z = HALF_X + BAY / 2.0, HALF_Z + BAY / 2.0
    for x, z in ((-1.5, -1), (1.5, -1), (-1.5, 1), (1.5, 1)):
        yield Place("lantern", x * BAY, SPRING + BAY / 2.0 + 0.02, z * outer_z)
    for x in (-outer_x, outer_x):
        yield Place("lantern", x, SPRING + BAY / 2.0 + 0.02, 0.0)
    yield Place("door", -HALF_X - BAY, GALLERY, 0.0, QUARTER)
    yield Place("crystal_shrine", HALF_X + BAY / 2.0 + 0.3, GALLERY, 0.0, -QUARTER)
    for x, z, yaw, number in _runs(BAY):
        if number > 0:
            yield Place("medallion", x, SPRING + 1.06, z, yaw)


def places() -> list[Place]:
    """Every node of the scene, in a fixed order."""
    once = [Place("shell", 0.0, 0.0, 0.0)]
    return [*once, *_architecture(), *_ceilings(), *_cloth(), *_props()]
