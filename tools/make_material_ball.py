"""Writes the shapes that materials are shown on: `python tools/make_material_ball.py`.

ball.glb: a ball with a groove on a foot, in a studio whose floor curves up into a wall. leaf.glb: a
leaf of one sheet and a bowl with walls a few millimetres thick, to be lit from behind. veins.png:
how much of that light the leaf lets through.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from atrium.glb import GlbWriter
from atrium.mesh import Mesh
from made_files import write_all

FOLDER = Path(__file__).resolve().parent.parent / "content" / "scenes" / "material_ball"
MAKER = "tools/make_material_ball.py"

Points = NDArray[np.float64]

BALL_RADIUS_M = 0.5
BALL_CENTRE_M = 0.56
GROOVE_DEG = (-38.0, -30.0)
"""Latitudes between which the ball is cut in: an edge, and a place that light hardly reaches."""
GROOVE_RADIUS_M = 0.44
VEINS, VEIN_TEXELS = 9, 512
"""Of the leaf, on each side of its rib; and of a side of their picture."""


def surface(points: Points, uv_scale: tuple[float, float], smooth_seams: bool = True) -> Mesh:
    """An indexed mesh over a grid of points (U, V, 3) with smooth normals, uv over the grid.

    `smooth_seams`: the grid closes along its first axis, so that its ends share their normals.
    """
    along = np.gradient(points, axis=0)
    if smooth_seams:
        seam = 0.5 * (points[1] - points[-2])
        along[0] = along[-1] = seam
    normal = np.cross(along, np.gradient(points, axis=1))
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = np.where(length > 1e-12, normal / np.maximum(length, 1e-12), 0.0)
    for end, inner in ((0, 1), (-1, -2)):  # poles, where the first axis has no length
        pole = length[:, end, 0] <= 1e-9
        mean = normal[:, inner].mean(axis=0)
        normal[pole, end] = mean / np.linalg.norm(mean)
    u, v = points.shape[:2]
    grid_u, grid_v = np.meshgrid(np.arange(u) / (u - 1), np.arange(v) / (v - 1), indexing="ij")
    uv = np.stack([grid_u * uv_scale[0], grid_v * uv_scale[1]], axis=-1)
    a = (np.arange(u - 1)[:, None] * v + np.arange(v - 1)[None]).reshape(-1)
    index = np.stack([a, a + v, a + v + 1, a, a + v + 1, a + 1], axis=1)
    corners = points.reshape(-1, 3)[index].reshape(-1, 3, 3)
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    index = index.reshape(-1, 3)[area > 1e-10]
    return Mesh(
        points.reshape(-1, 3).astype(np.float32),
        normal.reshape(-1, 3).astype(np.float32),
        uv.reshape(-1, 2).astype(np.float32),
        index.reshape(-1).astype(np.uint32),
    )


def lathe(profile: Sequence[tuple[float, float]], sides: int, uv: tuple[float, float]) -> Mesh:
    """A profile of (radius, height) m, from the bottom up, turned about y."""
    turn = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    r, y = np.array(profile, np.float64).T
    points = np.stack(
        [np.outer(np.sin(turn), r), np.tile(y, (sides + 1, 1)), np.outer(np.cos(turn), r)], axis=-1
    )
    points[-1] = points[0]
    return surface(points, uv)


def ball_profile() -> list[tuple[float, float]]:
    """The ball from pole to pole, cut in between GROOVE_DEG."""
    profile = []
    for degrees in np.linspace(-90.0, 90.0, 46).tolist():
        low, high = GROOVE_DEG
        radius = GROOVE_RADIUS_M if low < degrees < high else BALL_RADIUS_M
        angle = np.radians(degrees)
        profile.append((radius * np.cos(angle), BALL_CENTRE_M + radius * np.sin(angle)))
    profile[0], profile[-1] = (0.0, profile[0][1]), (0.0, profile[-1][1])
    return profile


def foot_profile() -> list[tuple[float, float]]:
    """A round foot under the ball."""
    return [(0.0, 0.0), (0.42, 0.0), (0.45, 0.015), (0.45, 0.05), (0.42, 0.07), (0.3, 0.08),
            (0.0, 0.08)]  # fmt: skip


def studio() -> Mesh:
    """A floor that curves up into a wall, 6 m wide."""
    bend = np.linspace(0.0, 0.5 * np.pi, 9)
    z = [3.0, *(-1.2 - 0.8 * np.sin(bend)), -2.0]
    y = [0.0, *(0.8 - 0.8 * np.cos(bend)), 3.0]
    side = np.array([-3.0, 3.0])
    points = np.stack(
        [np.repeat(side[:, None], len(z), 1), np.tile(y, (2, 1)), np.tile(z, (2, 1))], axis=-1
    )
    return surface(points, (6.0, 6.0), smooth_seams=False)


def leaf() -> Mesh:
    """One sheet, 0.7 m long: pointed, folded along its rib, waved along its rim."""
    t, s = np.linspace(0.0, 1.0, 33), np.linspace(-1.0, 1.0, 17)
    t, s = np.meshgrid(t, s, indexing="ij")
    half = 0.21 * np.sin(np.pi * t**0.8) + 0.002
    x = half * s
    z = 0.25 * np.abs(x) + 0.05 * np.sin(2.0 * np.pi * t) + 0.02 * np.sin(9.0 * t * np.pi) * s**2
    return surface(np.stack([x, 0.08 + 0.7 * t, -z], axis=-1), (1.0, 1.0), smooth_seams=False)


def veins() -> bytes:
    """How light passes the leaf: a rib, veins that run forward from it, and the
    fine net between them. Columns go from the leaf's foot to its tip, rows across it."""
    centre = (np.arange(VEIN_TEXELS) + 0.5) / VEIN_TEXELS
    along, across = np.meshgrid(centre, np.abs(2.0 * centre - 1.0))
    rib = np.exp(-((across / (0.035 * (1.2 - along))) ** 2))
    phase = (along - 0.32 * across**0.8) * VEINS
    off = np.abs(phase - np.round(phase)) / VEINS
    vein = 0.8 * np.exp(-((off / (0.007 * (1.15 - 0.7 * across))) ** 2))
    cells = np.sin(2.0 * np.pi * phase * 3.0) * np.sin(2.0 * np.pi * across * 17.0 + 4.0 * phase)
    net = 0.22 * np.exp(-((cells / 0.22) ** 2))
    passes = 1.0 - 0.78 * np.maximum(np.maximum(rib, vein), net)
    stream = io.BytesIO()
    Image.fromarray(np.round(255.0 * passes).astype(np.uint8)).save(stream, "PNG", optimize=True)
    return stream.getvalue()


def bowl_profile() -> list[tuple[float, float]]:
    """A bowl from its foot up its outside and down its inside; its wall thins towards the rim."""
    outside, inside = [], []
    for t in np.linspace(0.0, 1.0, 17).tolist():
        radius = 0.05 + 0.22 * np.sin(0.5 * np.pi * t) ** 0.8
        height = 0.02 + 0.36 * t**1.4
        wall = 0.05 * (1.0 - t) + 0.008
        outside.append((radius, height))
        inside.append((max(radius - wall, 0.0), height + 0.02 * (1.0 - t)))
    floor = [(0.0, inside[1][1]), (0.5 * inside[1][0], inside[1][1])]
    return [(0.0, 0.02), *outside, *reversed(inside[1:]), *reversed(floor)]


def glb(name: str, parts: Sequence[tuple[str, Mesh, int]], materials: Sequence[Any]) -> bytes:
    """(node name, mesh, material number) as a glTF 2.0 binary."""
    writer = GlbWriter()
    for entry in materials:
        writer.add("materials", entry)
    for part, mesh, material in parts:
        primitive = {**writer.primitive(mesh), "material": material}
        number = writer.add("meshes", {"name": part, "primitives": [primitive]})
        writer.node(part, number, (0.0, 0.0, 0.0), yaw=0.0, scale=1.0)
    return writer.bytes([], name, MAKER)


def material(
    name: str, color: tuple[float, float, float], roughness: float, double_sided: bool = False
) -> dict[str, Any]:
    """A dielectric."""
    pbr = {"baseColorFactor": [*color, 1.0], "metallicFactor": 0.0, "roughnessFactor": roughness}
    return {"name": name, "pbrMetallicRoughness": pbr, "doubleSided": double_sided}


def files() -> dict[str, bytes]:
    """File name -> content."""
    studio_paint = material("Studio", (0.42, 0.42, 0.43), 0.9)
    ball = [
        ("ball", lathe(ball_profile(), 64, (2.0, 1.0)), 0),
        ("foot", lathe(foot_profile(), 48, (2.0, 0.4)), 0),
        ("studio", studio(), 1),
    ]
    thin = [
        ("leaf", leaf(), 0),
        ("bowl", lathe(bowl_profile(), 48, (2.0, 1.0)), 1),
        ("studio", studio(), 2),
    ]
    return {
        "ball.glb": glb("ball", ball, [material("Ball", (0.75, 0.2, 0.12), 0.35), studio_paint]),
        "veins.png": veins(),
        "leaf.glb": glb(
            "leaf",
            thin,
            [
                material("Leaf", (0.12, 0.3, 0.05), 0.5, double_sided=True),
                material("Wax", (0.7, 0.45, 0.3), 0.4),
                studio_paint,
            ],
        ),
    }


def main() -> None:
    """Write all of them and say how large they are."""
    write_all(files(), FOLDER)


if __name__ == "__main__":
    main()
