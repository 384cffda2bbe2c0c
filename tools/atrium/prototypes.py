"""The atrium's meshes: each a few parts of one material, placed by `layout`."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from atrium import columns, props
from atrium.layout import BAY, EAVES, GALLERY, HALF_X, HALF_Z, LOGGIA, LOGGIA_SPRING, SLAB, SPRING
from atrium.mesh import Soup, join
from atrium.shapes import arc, arch_panel, box, groin_vault, revolve, ring, thick_strip, voussoirs

Parts: TypeAlias = list[tuple[str, Soup]]
"""(material, triangles), one primitive each."""

WALL_THICKNESS = 0.5
ARCADE_THICKNESS = 0.5
LOGGIA_THICKNESS = 0.42


def _band(out_from: float, out_to: float, low: float, high: float) -> Soup:
    """A rectangular ring round the court between two distances from the column line."""
    profile = [(out_from, low), (out_to, low), (out_to, high), (out_from, high)]
    return ring(profile, HALF_X, HALF_Z)


def shell() -> Parts:
    """Floors, outer walls, mouldings, ceiling and roof: what runs round the whole court."""
    edge = 0.38
    court = box((2 * (HALF_X - edge), 0.4, 2 * (HALF_Z - edge)), (0.0, -0.2, 0.0))
    string_course = ring(
        [
            (-0.22, 4.26),
            (-0.22, LOGGIA),
            (-0.47, LOGGIA),
            (-0.47, 4.53),
            (-0.42, 4.50),
            (-0.38, 4.42),
            (-0.31, 4.38),
            (-0.28, 4.26),
        ],
        HALF_X,
        HALF_Z,
    )
    cornice = ring(
        [
            (-0.15, 8.02),
            (-0.15, EAVES),
            (0.3, EAVES),
            (0.3, 8.45),
            (-0.62, 8.45),
            (-0.62, 8.37),
            (-0.54, 8.33),
            (-0.50, 8.24),
            (-0.43, 8.20),
            (-0.43, 8.13),
            (-0.28, 8.13),
            (-0.24, 8.02),
        ],
        HALF_X,
        HALF_Z,
    )
    wall_top = 8.45
    outer = BAY + WALL_THICKNESS
    roof = ring(
        [
            (-0.72, wall_top),
            (outer, wall_top),
            (outer + 0.15, wall_top),
            (outer + 0.15, 9.75),
            (outer, 9.75),
            (-0.72, 8.57),
        ],
        HALF_X,
        HALF_Z,
    )
    dado_cap = [(BAY - 0.10, 1.06), (BAY + 0.1, 1.06), (BAY + 0.1, 1.18), (BAY - 0.04, 1.18)]
    upper_dado = [(BAY - 0.06, LOGGIA), (BAY + 0.1, LOGGIA), (BAY + 0.1, 5.5), (BAY - 0.03, 5.5)]
    frieze = _band(BAY - 0.05, BAY + 0.1, 7.42, 7.66)
    return [
        ("marble_floor", court.box_mapped()),
        ("terracotta_floor", _band(edge, BAY + 0.1, -0.4, GALLERY).box_mapped()),
        ("limestone", join(_band(-edge, edge, -0.4, GALLERY), string_course, cornice)),
        ("ashlar", _band(BAY, outer, -0.4, wall_top).box_mapped()),
        ("red_stone", join(ring([*dado_cap], HALF_X, HALF_Z), frieze)),
        ("dark_stone", _band(BAY - 0.05, BAY + 0.1, GALLERY, 1.06)),
        ("plaster", ring(upper_dado, HALF_X, HALF_Z)),
        ("wood", join(_band(-0.22, BAY + 0.1, SLAB, LOGGIA), _band(0.2, BAY + 0.1, 7.95, EAVES))),
        ("roof_tiles", roof),
    ]


def ground_arch() -> Parts:
    """One bay of the lower arcade over its springing: wall and two-coloured arch stones."""
    radius = 1.1
    stones = voussoirs(radius - 0.02, 1.36, ARCADE_THICKNESS + 0.06, 13, 0.008)
    panel = arch_panel(BAY, SLAB - SPRING, radius, ARCADE_THICKNESS, 20)
    return [
        ("limestone", join(panel.box_mapped(), *stones[0::2])),
        ("red_stone", join(*stones[1::2])),
    ]


def loggia_arch() -> Parts:
    """Half a bay of the upper arcade over its springing."""
    radius = 0.53
    panel = arch_panel(BAY / 2.0, EAVES - LOGGIA_SPRING, radius, LOGGIA_THICKNESS, 12)
    moulding = thick_strip(arc(radius - 0.015, 12), arc(0.63, 12), LOGGIA_THICKNESS + 0.06)
    key = box((0.13, 0.24, LOGGIA_THICKNESS + 0.12), (0.0, 0.63, 0.0), 0.012)
    return [("limestone", join(panel.box_mapped(), moulding)), ("red_stone", key)]


def balustrade() -> Parts:
    """Rails and balusters between two pedestals of the loggia."""
    clear = BAY / 2.0 - 0.34
    rails = [
        box((clear, 0.11, 0.22), (0.0, 0.055, 0.0)),
        box((clear, 0.12, 0.26), (0.0, 0.84, 0.0), 0.02),
    ]
    turned = columns.baluster(0.68)
    spacing = clear / 4.0
    posts = [turned.moved(x=(k - 1.5) * spacing, y=0.105) for k in range(4)]
    return [("limestone", join(*rails, *posts))]


def corner_piers() -> Parts:
    """What closes the corner where two arcades meet, on both storeys."""
    lower = box((0.56, SLAB - SPRING, 0.56), (0.0, (SLAB + SPRING) / 2.0, 0.0))
    height = EAVES - LOGGIA_SPRING
    upper = box((0.46, height, 0.46), (0.0, LOGGIA_SPRING + height / 2.0, 0.0))
    return [("limestone", join(lower, upper).box_mapped())]


def rib() -> Parts:
    """A transverse arch between two vaults, over x = -BAY/2 .. BAY/2."""
    return [("limestone", thick_strip(arc(1.2, 18), arc(1.46, 18), 0.36))]


def dentils() -> Parts:
    """Seven blocks under the cornice."""
    blocks = [box((0.1, 0.12, 0.2), ((k - 3) * 0.2, 0.0, 0.3), 0.0) for k in range(7)]
    return [("limestone", join(*blocks))]


def beam() -> Parts:
    """A ceiling beam of the loggia along z, hung under y = 0."""
    return [("wood", box((0.14, 0.2, BAY - 0.1), (0.0, -0.24, 0.0), 0.02))]


def forge() -> Parts:
    """The centre of the court: a bronze bowl of molten metal on a stone foot."""
    return [
        ("dark_stone", props.forge_base()),
        ("bronze", props.forge_bowl()),
        ("melt", join(props.molten_metal(5), props.molten_streams())),
    ]


def crystal_shrine() -> Parts:
    """Glowing crystals that grow from a dark pedestal, facing +z."""
    rng = np.random.default_rng(9)
    foot = revolve(
        [
            (0.0, 0.0),
            (0.62, 0.0),
            (0.62, 0.14),
            (0.42, 0.24),
            (0.36, 0.62),
            (0.50, 0.80),
            (0.52, 0.90),
            (0.30, 0.98),
            (0.0, 1.02),
        ],
        10,
    )
    shards = [props.crystal(1.5, 0.2, 6).moved(y=1.6)]
    for k in range(7):
        size = rng.uniform(0.5, 0.95)
        lean = rng.uniform(0.35, 0.75)
        shard = props.crystal(size, 0.13 * size + 0.03, 6)
        c, s = np.cos(lean), np.sin(lean)
        tilt = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        leaning = Soup(shard.moved(y=0.4 * size).position @ tilt.T, shard.uv)
        turn = (k + rng.uniform(-0.25, 0.25)) * 2.0 * np.pi / 7.0
        shards.append(leaning.moved(x=0.1, y=0.9).turned_y(turn))
    return [("dark_stone", foot), ("crystal", join(*shards))]


def planter() -> Parts:
    """A potted ball tree."""
    centre, radius = 1.62, 0.56
    return [
        ("pottery", props.planter()),
        ("leaves_dark", props.shrub_core(radius).moved(y=centre)),
        ("leaves", props.leaves(radius, 280, 7).moved(y=centre)),
    ]


def medallion() -> Parts:
    """A bronze boss on the spandrel's court face."""
    turned = revolve(
        [
            (0.0, -0.04),
            (0.25, -0.04),
            (0.25, 0.02),
            (0.20, 0.05),
            (0.17, 0.025),
            (0.10, 0.03),
            (0.0, 0.08),
        ],
        14,
    )
    facing = turned.position[..., [0, 2, 1]] * np.array([1.0, -1.0, 1.0])
    return [("bronze", Soup(facing, turned.uv).moved(z=ARCADE_THICKNESS / 2.0))]


def curtain(color: str) -> Callable[[], Parts]:
    """A tied-back curtain on its rod, across one bay of the lower arcade."""
    span, seed = 2.2, {"red": 1, "green": 2, "blue": 3}[color]
    return lambda: [
        ("bronze", props.rod(span).moved(x=-span / 2.0)),
        (f"cloth_{color}", props.curtain(span, 2.36, seed).moved(x=-span / 2.0 + 0.05)),
    ]


def banner(color: str) -> Callable[[], Parts]:
    """A long cloth from the cornice over the loggia."""
    seed = {"red": 4, "green": 5, "blue": 6}[color]
    return lambda: [(f"cloth_{color}", props.banner(1.25, 4.0, 2.2, 0.075, seed))]


def door() -> Parts:
    """The portal in the end wall, facing +z."""
    return [
        ("wood", props.door_leaf(1.7, 2.45).moved(z=0.05)),
        ("limestone", props.door_surround(1.7, 2.45)),
    ]


def lantern() -> Parts:
    """A hanging lantern, hook at y = 0."""
    return [("bronze", props.lantern_frame()), ("lantern", props.lantern_glow())]


PROTOTYPES: dict[str, Callable[[], Parts]] = {
    "shell": shell,
    "ground_column": lambda: [("limestone", columns.ground_column(SPRING - GALLERY))],
    "loggia_column": lambda: [("limestone", columns.loggia_column(LOGGIA_SPRING - LOGGIA, 0.9))],
    "ground_arch": ground_arch,
    "loggia_arch": loggia_arch,
    "balustrade": balustrade,
    "corner_piers": corner_piers,
    "vault": lambda: [("plaster", groin_vault(BAY, SLAB - SPRING, 12, 3))],
    "rib": rib,
    "corbel": lambda: [("limestone", columns.corbel())],
    "dentils": dentils,
    "beam": beam,
    "forge": forge,
    "crystal_shrine": crystal_shrine,
    "planter": planter,
    "medallion": medallion,
    "door": door,
    "lantern": lantern,
    **{f"curtain_{color}": curtain(color) for color in ("red", "green", "blue")},
    **{f"banner_{color}": banner(color) for color in ("red", "green", "blue")},
}
"""Every mesh of the scene by name, made when called."""

THIN = frozenset({"cloth_red", "cloth_green", "cloth_blue", "leaves"})
"""Materials of thin double-sided sheets; parts of every other material are closed solids."""
