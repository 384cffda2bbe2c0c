"""What stands in each room. Metres, y up."""

from __future__ import annotations

from collections.abc import Callable

from atrium.mesh import Soup
from rooms.room import Glass, Paint, Point, Room, ball, face, span, torus

WHITE = Paint((0.75, 0.75, 0.75))
RED = Paint((0.63, 0.065, 0.05))
GREEN = Paint((0.14, 0.45, 0.091))

Corners = tuple[Point, Point, Point, Point]


def cornell_box() -> Room:
    """Cornell University's box by its measured coordinates (graphics.cornell.edu/online/box/data).

    Their millimetres as metres. Colours are the customary Rec. 709 ones of the measured spectra;
    the lamp hangs half a millimetre under the ceiling instead of lying in it.
    """
    room = Room(
        {
            "white": Paint((0.725, 0.71, 0.68)),
            "red": RED,
            "green": GREEN,
            "lamp": Paint((0.78, 0.78, 0.78), glow=(17.0, 12.0, 4.0)),
        }
    )

    def walls(name: str, paint: str, *faces: Corners) -> None:
        soups = [face(*(_metres(point) for point in corners)) for corners in faces]
        room.add(name, paint, *soups)

    walls("floor", "white", ((552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)))
    walls(
        "ceiling", "white", ((556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0))
    )
    walls(
        "back wall",
        "white",
        ((549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)),
    )
    walls("right wall", "green", ((0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)))
    walls(
        "left wall", "red", ((552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0))
    )
    walls(
        "lamp", "lamp", ((343, 548.3, 227), (343, 548.3, 332), (213, 548.3, 332), (213, 548.3, 227))
    )
    walls(
        "short block",
        "white",
        ((130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114)),
        ((290, 0, 114), (290, 165, 114), (240, 165, 272), (240, 0, 272)),
        ((130, 0, 65), (130, 165, 65), (290, 165, 114), (290, 0, 114)),
        ((82, 0, 225), (82, 165, 225), (130, 165, 65), (130, 0, 65)),
        ((240, 0, 272), (240, 165, 272), (82, 165, 225), (82, 0, 225)),
    )
    walls(
        "tall block",
        "white",
        ((423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)),
        ((423, 0, 247), (423, 330, 247), (472, 330, 406), (472, 0, 406)),
        ((472, 0, 406), (472, 330, 406), (314, 330, 456), (314, 0, 456)),
        ((314, 0, 456), (314, 330, 456), (265, 330, 296), (265, 0, 296)),
        ((265, 0, 296), (265, 330, 296), (423, 330, 247), (423, 0, 247)),
    )
    return room


def _metres(millimetres: Point) -> Point:
    x, y, z = (round(c / 1000.0, 6) for c in millimetres)
    return x, y, z


def corridor() -> Room:
    """Two arms of a passage at a right angle; a lamp fills the end of the one out of sight."""
    room = Room(
        {
            "white": WHITE,
            "ochre": Paint((0.7, 0.42, 0.15)),
            "blue": Paint((0.15, 0.3, 0.6)),
            "lamp": Paint((0.0, 0.0, 0.0), glow=(12.0, 11.0, 9.0)),
        }
    )
    thick = 0.2
    room.add(
        "floor",
        "white",
        span((0, -thick, 0), (6, 0, 2)),
        span((4, -thick, -4), (6, 0, 0)),
    )
    room.add(
        "ceiling",
        "white",
        span((0, 2.4, 0), (6, 2.4 + thick, 2)),
        span((4, 2.4, -4), (6, 2.4 + thick, 0)),
    )
    tall = (-thick, 2.4 + thick)
    room.add("long wall", "white", _wall(-thick, 6 + thick, 2, 2 + thick, tall))
    room.add("near end", "white", _wall(-thick, 0, -thick, 2, tall))
    room.add("inner walls", "blue", _wall(0, 4, -thick, 0, tall))
    room.add("inner side", "white", _wall(4 - thick, 4, -4 - thick, -thick, tall))
    room.add("corner wall", "ochre", _wall(6, 6 + thick, -4 - thick, 2, tall))
    room.add("far end", "white", _wall(4, 6, -4 - thick, -4, tall))
    z = -3.98
    room.add("lamp", "lamp", face((4.3, 0.5, z), (5.7, 0.5, z), (5.7, 2.1, z), (4.3, 2.1, z)))
    room.add("block", "white", span((2.6, 0, 0.2), (3.2, 0.9, 0.8)))
    return room


def _wall(x0: float, x1: float, z0: float, z1: float, heights: tuple[float, float]) -> Soup:
    return span((x0, heights[0], z0), (x1, heights[1], z1))


def grate() -> Room:
    """A room whose only lamp glows behind a grate of bars, and draws them over floor and walls."""
    room = Room(
        {
            "white": WHITE,
            "warm": Paint((0.7, 0.5, 0.35)),
            "iron": Paint((0.2, 0.2, 0.22), roughness=0.6),
            "lamp": Paint((0.0, 0.0, 0.0), glow=(20.0, 18.0, 14.0)),
        }
    )
    room.add("floor", "white", span((-2, -0.2, -2), (2, 0, 2)))
    room.add("ceiling", "white", span((-2, 3, -2), (2, 3.2, 2)))
    room.add("back", "white", span((-2.2, -0.2, -2.2), (2.2, 3.2, -2)))
    room.add("front", "white", span((-2.2, -0.2, 2), (2.2, 3.2, 2.2)))
    room.add("left", "warm", span((-2.2, -0.2, -2), (-2, 3.2, 2)))
    room.add("right", "white", span((2, -0.2, -2), (2.2, 3.2, 2)))
    z = -1.95
    room.add("lamp", "lamp", face((-0.5, 0.8, z), (0.5, 0.8, z), (0.5, 2.0, z), (-0.5, 2.0, z)))
    bars = [span((x, 0.6, -1.6), (x + 0.08, 2.2, -1.52)) for x in (-0.7, -0.38, -0.06, 0.26, 0.58)]
    bars += [span((-0.7, y, -1.52), (0.66, y + 0.08, -1.44)) for y in (0.7, 1.1, 1.5, 1.9)]
    room.add("grate", "iron", *bars)
    room.add("block", "white", span((0.7, 0, -0.4), (1.3, 0.7, 0.2)))
    return room


def glossy_floor() -> Room:
    """Coloured columns and two lamps over a floor of polished metal."""
    room = Room(
        {
            "white": WHITE,
            "floor": Paint((0.6, 0.58, 0.55), roughness=0.25, metallic=1.0),
            "red": RED,
            "green": GREEN,
            "blue": Paint((0.1, 0.2, 0.6)),
            "lamp": Paint((0.0, 0.0, 0.0), glow=(9.0, 9.0, 9.0)),
        }
    )
    room.add("floor", "floor", span((-2.5, -0.2, -2.5), (2.5, 0, 2.5)))
    room.add("ceiling", "white", span((-2.5, 3, -2.5), (2.5, 3.2, 2.5)))
    room.add("back", "white", span((-2.7, -0.2, -2.7), (2.7, 3.2, -2.5)))
    room.add("front", "white", span((-2.7, -0.2, 2.5), (2.7, 3.2, 2.7)))
    room.add("left", "red", span((-2.7, -0.2, -2.5), (-2.5, 3.2, 2.5)))
    room.add("right", "green", span((2.5, -0.2, -2.5), (2.7, 3.2, 2.5)))
    room.add("column", "white", span((-1.4, 0, -1.5), (-1.0, 2.2, -1.1)))
    room.add("block", "blue", span((0.2, 0, -1.2), (0.9, 0.8, -0.5)))
    room.add("ball", "white", ball(0.4, (1.5, 0.4, 0.3)))
    for name, x in (("left lamp", -1.2), ("right lamp", 1.2)):
        y, low, high = 2.97, x - 0.4, x + 0.4
        room.add(name, "lamp", face((low, y, -0.4), (high, y, -0.4), (high, y, 0.4), (low, y, 0.4)))
    return room


def under_sky() -> Room:
    """Bodies on a round of white ground with nothing around them but the environment."""
    room = Room(
        {
            "white": WHITE,
            "clay": Paint((0.65, 0.3, 0.18)),
            "brass": Paint((0.85, 0.65, 0.35), roughness=0.3, metallic=1.0),
        }
    )
    room.add("ground", "white", span((-2, -0.2, -2), (2, 0, 2)))
    room.add("ball", "white", ball(0.6, (-0.5, 0.6, 0.0)))
    room.add("ring", "brass", torus(0.4, 0.14, (0.7, 0.14, 0.5)))
    room.add("block", "clay", span((0.5, 0, -0.9), (1.0, 1.3, -0.4)))
    return room


def glass() -> Room:
    """Balls, a block and a thin pane of glass over a chequered floor, before coloured walls."""
    smoke = ((0.9, 0.45, 0.12), 0.35)
    room = Room(
        {
            "light": Paint((0.7, 0.68, 0.64)),
            "dark": Paint((0.08, 0.09, 0.11)),
            "ochre": Paint((0.7, 0.42, 0.15)),
            "blue": Paint((0.12, 0.24, 0.5)),
            "brick": Paint((0.5, 0.16, 0.1)),
            "clear": Paint((1.0, 1.0, 1.0), 0.0, glass=Glass(0.9)),
            "amber": Paint((1.0, 1.0, 1.0), 0.0, glass=Glass(0.6, smoke)),
            "frosted": Paint((1.0, 1.0, 1.0), 0.3, glass=Glass(0.6)),
            "block": Paint((1.0, 1.0, 1.0), 0.0, glass=Glass(0.06)),
            "pane": Paint((0.8, 0.95, 0.9), 0.0, glass=Glass()),
        }
    )
    tiles: dict[str, list[Soup]] = {"light": [], "dark": []}
    for i in range(10):
        for j in range(10):
            x, z = -2.5 + 0.5 * i, -2.5 + 0.5 * j
            corners = ((x, 0, z + 0.5), (x + 0.5, 0, z + 0.5), (x + 0.5, 0, z), (x, 0, z))
            tiles["dark" if (i + j) % 2 else "light"].append(face(*corners))
    for paint, soups in tiles.items():
        room.add(f"{paint} tiles", paint, *soups)
    room.add("ground", "dark", span((-2.5, -0.2, -2.5), (2.5, -0.02, 2.5)))
    room.add("back", "ochre", span((-2.5, 0, -2.7), (0.6, 1.7, -2.5)))
    room.add("back right", "blue", span((0.6, 0, -2.7), (2.5, 1.7, -2.5)))
    room.add("side", "brick", span((-2.7, 0, -2.7), (-2.5, 1.7, 0.5)))
    room.add("clear ball", "clear", ball(0.45, (-0.75, 0.45, 0.1), rings=32))
    room.add("amber ball", "amber", ball(0.3, (0.2, 0.3, 0.75), rings=24))
    room.add("frosted ball", "frosted", ball(0.3, (0.45, 0.3, -0.75), rings=24))
    room.add("glass block", "block", span((-0.4, 0, -1.4), (0.1, 1.0, -1.34)))
    room.add(
        "pane", "pane", face((0.95, 0, 0.5), (1.75, 0, 0.0), (1.75, 1.3, 0.0), (0.95, 1.3, 0.5))
    )
    return room


PLANS: dict[str, Callable[[], Room]] = {
    "cornell_box": cornell_box,
    "corridor": corridor,
    "grate": grate,
    "glossy_floor": glossy_floor,
    "under_sky": under_sky,
    "glass": glass,
}
