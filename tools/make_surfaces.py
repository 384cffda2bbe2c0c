"""Writes what `surfaces.toml` shows decals and glass on: `python tools/make_surfaces.py`.

room.glb: a floor and a wall that curves around it. pedestals.glb: what glass stands on. glass.glb:
a clear ball, a frosted one, a bottle and a window pane. PNG files: the decals' pictures.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from atrium.glb import GlbWriter
from atrium.mesh import Mesh
from made_files import write_all
from make_material_ball import lathe, material, surface
from rooms.room import GLASS_EXTENSIONS, Glass, glass_extensions
from surfaces.pictures import PICTURES

FOLDER = Path(__file__).resolve().parent.parent / "content" / "scenes" / "surfaces"
MAKER = "tools/make_surfaces.py"

WALL_RADIUS_M = 3.0
WALL_HEIGHT_M = 2.6
WALL_FOOT_M = 0.2
"""Below the floor: a wall that ends on it would let light through the gap that filters see."""
BALL_RADIUS_M = 0.3
PANE_M = (0.7, 1.0, 0.02)
PEDESTAL_M = (0.28, 0.5)
"""Radius and height."""


def wall() -> Mesh:
    """Two thirds of an upright tube, seen from inside, its open side towards +z."""
    turn = np.radians(np.linspace(-120.0, 120.0, 65))
    x, z = WALL_RADIUS_M * np.sin(turn), -WALL_RADIUS_M * np.cos(turn)
    y = np.array([-WALL_FOOT_M, WALL_HEIGHT_M])
    points = np.stack(
        [np.repeat(x[:, None], 2, 1), np.tile(y, (65, 1)), np.repeat(z[:, None], 2, 1)], axis=-1
    )
    return surface(points, (12.0, 2.6), smooth_seams=False)


def floor() -> Mesh:
    """8 m square."""
    side = np.array([-4.0, 4.0])
    x, z = np.meshgrid(side, side[::-1], indexing="ij")
    return surface(np.stack([x, np.zeros_like(x), z], axis=-1), (8.0, 8.0), smooth_seams=False)


def pedestal() -> Mesh:
    """A round block with a bevelled top."""
    r, h = PEDESTAL_M
    profile = [(0.0, 0.0), (r, 0.0), (r, h - 0.02), (r - 0.006, h - 0.006), (r - 0.02, h), (0.0, h)]
    return lathe(profile, 48, (2.0, 1.0))


def ball() -> Mesh:
    """Around the origin."""
    angle = np.radians(np.linspace(-90.0, 90.0, 37))
    profile = [(BALL_RADIUS_M * float(np.cos(a)), BALL_RADIUS_M * float(np.sin(a))) for a in angle]
    profile[0], profile[-1] = (0.0, -BALL_RADIUS_M), (0.0, BALL_RADIUS_M)
    return lathe(profile, 72, (2.0, 1.0))


def bottle() -> Mesh:
    """A bottle of one wall, 0.55 m high, standing on y = 0."""
    body = [(0.0, 0.0), (0.1, 0.0), (0.115, 0.012), (0.118, 0.03), (0.118, 0.3)]
    turn = np.linspace(0.0, 1.0, 9)[1:].tolist()
    shoulder = [(0.118 - 0.083 * t * t * (3 - 2 * t), 0.3 + 0.11 * t) for t in turn]
    neck = [(0.035, 0.51), (0.044, 0.515), (0.044, 0.545), (0.035, 0.55), (0.03, 0.55)]
    return lathe([*body, *shoulder, *neck], 64, (2.0, 1.0))


def pane() -> Mesh:
    """An upright plate around the origin, facing z."""
    half = np.array(PANE_M) / 2
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half[:2]
    parts = []
    for sign in (1.0, -1.0):
        x = corners[:, 0] * sign
        parts.append(np.stack([x, corners[:, 1], np.full(4, sign * half[2])], axis=1))
    position = np.concatenate(parts)
    normal = np.repeat([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]], 4, axis=0)
    uv = np.tile([[0, 1], [1, 1], [1, 0], [0, 0]], (2, 1))
    index = np.array([0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7])
    return Mesh(position.astype("f4"), normal.astype("f4"), uv.astype("f4"), index.astype("u4"))


def pane_rim() -> Mesh:
    """The four narrow sides of the pane: light that comes out of them went a long way in glass."""
    x, y, z = np.array(PANE_M) / 2
    outline = np.array([[-x, -y], [x, -y], [x, y], [-x, y]])
    position, normal, index = [], [], []
    for k in range(4):
        a, b = outline[k], outline[(k + 1) % 4]
        along = (b - a) / np.linalg.norm(b - a)
        position += [[*a, z], [*a, -z], [*b, -z], [*b, z]]
        normal += [[along[1], -along[0], 0.0]] * 4
        index += [4 * k + corner for corner in (0, 1, 2, 0, 2, 3)]
    return Mesh(
        np.array(position, "f4"), np.array(normal, "f4"),
        np.zeros((16, 2), "f4"), np.array(index, "u4"),
    )  # fmt: skip


def glass(
    name: str,
    roughness: float = 0.0,
    thickness: float = 0.0,
    color: tuple[float, float, float] = (1.0, 1.0, 1.0),
    attenuation: tuple[tuple[float, float, float], float] | None = None,
    double_sided: bool = False,
) -> dict[str, Any]:
    """Wholly transmissive; thickness in m, attenuation as (colour, distance in m)."""
    made = material(name, color, roughness, double_sided)
    return {**made, "extensions": glass_extensions(Glass(thickness, attenuation))}


def glb(name: str, parts: list[tuple[str, Mesh, tuple[float, float, float], dict[str, Any]]],
        extensions: list[str]) -> bytes:  # fmt: skip
    """(node name, mesh, place, material) as a glTF 2.0 binary; equal materials are one."""
    writer = GlbWriter()
    known: dict[str, int] = {}
    for part, mesh, place, entry in parts:
        key = json.dumps(entry, sort_keys=True)
        if key not in known:
            known[key] = writer.add("materials", entry)
        primitive = {**writer.primitive(mesh), "material": known[key]}
        number = writer.add("meshes", {"name": part, "primitives": [primitive]})
        writer.node(part, number, place, yaw=0.0, scale=1.0)
    return writer.bytes(extensions, name, MAKER)


def files() -> dict[str, bytes]:
    """File name -> content."""
    plaster = material("Plaster", (0.62, 0.58, 0.5), 0.95)
    slab = material("Slab", (0.23, 0.22, 0.21), 0.55)
    wood = material("Wood", (0.3, 0.17, 0.09), 0.45)
    amber = ((0.75, 0.3, 0.03), 0.05)
    room = [
        ("wall", wall(), (0.0, 0.0, 0.0), plaster),
        ("floor", floor(), (0.0, 0.0, 0.0), slab),
    ]
    stands = [
        (f"pedestal{n}", pedestal(), (x, 0.0, z), wood)
        for n, (x, z) in enumerate(((-1.05, -0.3), (-0.15, 0.1), (0.8, -0.25)))
    ]
    glasses = [
        ("clear", ball(), (-1.05, 0.8, -0.3), glass("Clear", thickness=2 * BALL_RADIUS_M)),
        ("frosted", ball(), (-0.15, 0.8, 0.1), glass("Frosted", 0.35, thickness=2 * BALL_RADIUS_M)),
        ("bottle", bottle(), (0.8, 0.5, -0.25),
         glass("Amber", 0.03, thickness=0.03, attenuation=amber, double_sided=True)),
        ("pane", pane(), (1.65, 0.5, 0.5), glass("Pane", color=(0.75, 0.95, 0.88))),
        ("pane rim", pane_rim(), (1.65, 0.5, 0.5), material("Pane rim", (0.16, 0.42, 0.34), 0.15)),
    ]  # fmt: skip
    return {
        "room.glb": glb("room", room, []),
        "pedestals.glb": glb("pedestals", stands, []),
        "glass.glb": glb("glass", glasses, GLASS_EXTENSIONS),
        **{name: make() for name, make in PICTURES.items()},
    }


def main() -> None:
    """Write all of them and say how large they are."""
    write_all(files(), FOLDER)


if __name__ == "__main__":
    main()
