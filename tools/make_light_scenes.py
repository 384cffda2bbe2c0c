"""Writes the scenes that show lights: `python tools/make_light_scenes.py`.

many_lights.toml, the atrium at night under 256 lamps, with festival/lamps.glb, the bulbs and
sconces that are seen, and festival/sconce.ies, which throws light up and down a wall;
light_sizes.toml, the same lamp at five sizes over a glossy floor, with festival/stage.glb.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

from atrium.glb import GlbWriter
from atrium.layout import BAY, BAYS_X, EAVES, GALLERY, HALF_X, HALF_Z, LOGGIA
from atrium.mesh import indexed
from atrium.shapes import revolve
from made_files import write_all
from rooms.room import Paint, Room, ball, span

SCENES = Path(__file__).resolve().parent.parent / "content" / "scenes"

STRINGS = ((-6.4, -4.4), (-2.4, -4.0), (0.6, -1.0), (2.4, 4.0), (4.4, 6.4), (7.6, 7.6))
"""x at the near and at the far eave of each string of lanterns."""
BULBS = 22
"""Lanterns a string."""
SAG_M = 2.4
RAIL_M = 0.95
"""Height of the balustrade's top over the loggia's floor."""
SCONCE_M = 1.75
"""Height of a sconce over the gallery's floor."""
WALL_GAP_M = 0.14

PAPER = {
    "amber": (1.0, 0.62, 0.30),
    "rose": (1.0, 0.30, 0.28),
    "jade": (0.35, 1.0, 0.55),
    "azure": (0.35, 0.60, 1.0),
}
"""Tints of lanterns, linear."""
FLAME = (1.0, 0.75, 0.45)


@dataclass(frozen=True)
class Lamp:
    """One light and what is seen of it. reach, m: its range; shape: a mesh of lamps.glb."""

    shape: str
    place: tuple[float, float, float]
    color: tuple[float, float, float]
    candela: float
    reach: float
    temperature: int = 0
    sconce: bool = False

    def line(self) -> str:
        """Its table in the scene file."""
        x, y, z = self.place
        parts = [
            'kind = "point"',
            f"position = [{x:.3f}, {y:.3f}, {z:.3f}]",
            f"color = [{', '.join(f'{c:g}' for c in self.color)}]",
            f"intensity = {self.candela:g}",
            f"range = {self.reach:g}",
        ]
        if self.temperature:
            parts.append(f"temperature = {self.temperature}")
        parts.append('ies = "festival/sconce.ies"' if self.sconce else "casts_shadow = false")
        return f"  {{ {', '.join(parts)} }},"


def _strings() -> Iterator[Lamp]:
    """Paper lanterns on catenaries over the court, from eave to eave."""
    names = list(PAPER)
    for number, (near, far) in enumerate(STRINGS):
        for k in range(BULBS):
            t = (k + 0.5) / BULBS
            x = near + (far - near) * t
            y = EAVES - 0.35 - SAG_M * 4.0 * t * (1.0 - t)
            name = names[(k + number) % len(names)] if k % 2 else "amber"
            z = HALF_Z * (2.0 * t - 1.0)
            yield Lamp(f"lantern_{name}", (x, y, z), PAPER[name], 1.3, 4.6)


def _candles() -> Iterator[Lamp]:
    """Candles on the balustrades, one over each second baluster."""
    y = LOGGIA + RAIL_M + 0.1
    for k, side in product(range(24), (-1, 1)):
        yield Lamp("flame", ((k - 11.5) * 0.7, y, side * HALF_Z), FLAME, 0.32, 2.2, 1900)
    for k, side in product(range(12), (-1, 1)):
        yield Lamp("flame", (side * HALF_X, y, (k - 5.5) * 0.7), FLAME, 0.32, 2.2, 1900)


def _sconces() -> Iterator[Lamp]:
    """Open cylinders on the outer walls of the gallery, one a bay."""
    y, wall = GALLERY + SCONCE_M, BAY - WALL_GAP_M
    for k, side in product(range(BAYS_X + 2), (-1, 1)):
        x = (k - (BAYS_X + 1) / 2.0) * BAY
        yield Lamp("sconce", (x, y, side * (HALF_Z + wall)), (1, 1, 1), 5.0, 4.5, 2600, True)
    for k, side in product(range(3), (-1, 1)):
        if k != 1:  # where the door and the shrine are
            place = (side * (HALF_X + wall), y, (k - 1) * BAY)
            yield Lamp("sconce", place, (1, 1, 1), 5.0, 4.5, 2600, True)


def _floor() -> Iterator[Lamp]:
    """Candles on the step of the gallery."""
    y = GALLERY + 0.09
    for x, side in product((-5.6, -2.8, 0.0, 2.8, 5.6), (-1, 1)):
        for dx in (-0.55, 0.0, 0.6):
            z = side * (HALF_Z - 0.05 - 0.08 * (dx > 0))
            yield Lamp("flame", (x + 1.4 + dx, y, z), FLAME, 0.28, 2.0, 1900)
    for side in (-1, 1):
        yield Lamp("flame", (side * (HALF_X - 0.1), y, 1.3), FLAME, 0.28, 2.0, 1900)


def lamps() -> list[Lamp]:
    """All 256."""
    return [*_strings(), *_candles(), *_sconces(), *_floor()]


def lamps_glb() -> bytes:
    """Spheres that glow and cylinders that do not, at their lamps."""
    glb = GlbWriter()
    shapes: dict[str, int] = {}

    def shape(name: str, line: list[tuple[float, float]], material: dict[str, object]) -> None:
        mesh = indexed(revolve(line, 10), 60.0, 1.0)
        primitive = {**glb.primitive(mesh), "material": glb.add("materials", material)}
        shapes[name] = glb.add("meshes", {"name": name, "primitives": [primitive]})

    def ball(radius: float, stretch: float) -> list[tuple[float, float]]:
        angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 7)
        return [(radius * float(np.cos(a)), stretch * radius * float(np.sin(a))) for a in angles]

    for name, color in PAPER.items():
        shape(f"lantern_{name}", ball(0.085, 1.15), _glow(f"lantern_{name}", color, 2.2))
    shape("flame", ball(0.022, 2.6), _glow("flame", (1.0, 0.55, 0.18), 30.0))
    bronze = {"baseColorFactor": [0.35, 0.2, 0.1, 1.0], "metallicFactor": 1.0,
              "roughnessFactor": 0.35}  # fmt: skip
    wall = [(0.058, -0.11), (0.064, -0.11), (0.064, 0.11), (0.058, 0.11), (0.058, -0.11)]
    shape("sconce", wall, {"name": "sconce", "doubleSided": True, "pbrMetallicRoughness": bronze})
    for number, lamp in enumerate(lamps()):
        glb.node(f"{lamp.shape}_{number:03d}", shapes[lamp.shape], lamp.place, 0.0, 1.0)
    extensions = ["KHR_materials_emissive_strength"]
    return glb.bytes(extensions, "lamps", "tools/make_light_scenes.py")


def _glow(name: str, color: tuple[float, float, float], strength: float) -> dict[str, object]:
    return {
        "name": name,
        "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0.0},
        "emissiveFactor": list(color),
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}},
    }


def sconce_ies() -> str:
    """A lamp in an open tube: two beams along the wall, the upper one the stronger, with a ring."""
    vertical = np.arange(0, 181, 5)
    cosine = np.cos(np.radians(vertical))
    ring = 0.25 * np.exp(-(((np.minimum(vertical, 180 - vertical) - 27) / 5.0) ** 2))
    beam = np.abs(cosine) ** 9 + ring
    candela = 400.0 * beam * np.where(cosine < 0.0, 1.0, 0.7)
    lines = [" ".join(f"{v:.1f}" for v in candela[k : k + 10]) for k in range(0, len(candela), 10)]
    angles = " ".join(str(v) for v in vertical)
    return (
        "IESNA:LM-63-2002\n[TEST] none: computed\n[MANUFAC] elemental\n[LUMINAIRE] tube sconce\n"
        f"TILT=NONE\n1 -1 1 {len(vertical)} 1 1 2 -0.12 0 0.22\n1 1 6\n{angles}\n0\n"
        + "\n".join(lines)
        + "\n"
    )


HEAD = """\
# The atrium at night under 256 lamps. Generated by tools/make_light_scenes.py.
name = "Many lights"
exposure_ev = -0.9

lights = [    # 132 lanterns, 104 candles and 20 sconces with a photometric file and shadows
"""
TAIL = """\
]

[[models]]
file = "atrium/atrium.glb"

[[models]]
file = "festival/lamps.glb"

[environment]
file = "atrium/sky.hdr"
tint = [0.3, 0.5, 1.0]
intensity = 0.12

[[cameras]]
name = "courtyard"
eye = [-7.6, 1.7, 1.3]
target = [2.4, 3.4, -0.9]
fov_y_deg = 62.0

[[cameras]]
name = "gallery"
eye = [-9.4, 6.3, 2.3]
target = [0.0, 4.2, -0.6]
fov_y_deg = 55.0

[[cameras]]
name = "arcade"
eye = [-7.2, 1.7, -5.6]
target = [4.0, 2.0, -5.3]
fov_y_deg = 60.0

[settings]
"gi.bounces" = 2
"""


SIZES_M = (0.0, 0.06, 0.15, 0.3, 0.6)
"""Radii of the lamps over the glossy floor."""
APART_M = 2.4


def stage_glb() -> bytes:
    """A glossy floor before a wall, with a post and a ball below each lamp."""
    room = Room({
        "floor": Paint((0.04, 0.04, 0.05), roughness=0.16),
        "wall": Paint((0.10, 0.10, 0.11)),
        "post": Paint((0.75, 0.72, 0.66)),
    })  # fmt: skip
    room.add("floor", "floor", span((-7.5, -0.2, -3.0), (7.5, 0, 5.5)))
    room.add("wall", "wall", span((-7.5, 0, -3.2), (7.5, 3.4, -3.0)))
    for k in range(len(SIZES_M)):
        x = (k - 2) * APART_M
        room.add(f"screen {k}", "wall", span((x - 1.24, 0, -3.0), (x - 1.16, 3.4, -1.2)))
        room.add(f"post {k}", "post", span((x - 0.05, 0, -2.5), (x + 0.05, 1.5, -2.4)))
        room.add(f"ball {k}", "post", ball(0.22, (x + 0.55, 0.22, -2.0)))
    return room.glb("stage")


def sizes_toml() -> str:
    """The scene of the stage."""
    lamps = "\n".join(
        f'  {{ kind = "point", position = [{(k - 2) * APART_M:g}, 1.7, -1.6], intensity = 4.0, '
        f"range = 12.0, source_radius = {radius:g}, temperature = 4500 }},"
        for k, radius in enumerate(SIZES_M)
    )
    return f"""\
# The same lamp as a point and as soft spheres. Generated by tools/make_light_scenes.py.
name = "Light sizes"
exposure_ev = 1.0

lights = [
{lamps}
]

[[models]]
file = "festival/stage.glb"

[[cameras]]
name = "front"
eye = [0.0, 2.4, 9.0]
target = [0.0, 0.45, -1.0]
fov_y_deg = 34.0

[settings]
"eye_adaptation.min_brightness" = 1.0
"eye_adaptation.max_brightness" = 1.0
"""


def files() -> dict[str, bytes]:
    """Path in content/scenes -> content."""
    many = HEAD + "\n".join(lamp.line() for lamp in lamps()) + "\n" + TAIL
    return {
        "festival/lamps.glb": lamps_glb(),
        "festival/sconce.ies": sconce_ies().encode("ascii"),
        "festival/stage.glb": stage_glb(),
        "many_lights.toml": many.encode(),
        "light_sizes.toml": sizes_toml().encode(),
    }


def main() -> None:
    """Write all files."""
    write_all(files(), SCENES)


if __name__ == "__main__":
    main()
