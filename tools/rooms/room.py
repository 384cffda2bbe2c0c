"""A scene of a few plain solids: materials by name, parts that wear them, one glb."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from atrium.glb import GlbWriter
from atrium.mesh import Soup, indexed, join, sheet, triangles
from atrium.shapes import box, revolve

Point = tuple[float, float, float]

CREASE_DEG = 40.0
SPHERE_RINGS = 16
GLASS_EXTENSIONS = [
    "KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_volume",
]  # fmt: skip


@dataclass(frozen=True)
class Glass:
    """Of what a material lets through wholly: index 1.5, thickness in m (0: a thin wall), and the
    colour that is left after a distance in m."""

    thickness: float = 0.0
    attenuation: tuple[Point, float] | None = None


@dataclass(frozen=True)
class Paint:
    """A material: linear base colour, radiance in nit where it glows, and what makes it glass."""

    color: Point
    roughness: float = 1.0
    metallic: float = 0.0
    glow: Point = (0.0, 0.0, 0.0)
    glass: Glass | None = None


@dataclass
class Room:
    """Parts in the order in which they were added; `glb()` is the file."""

    paints: dict[str, Paint]
    parts: list[tuple[str, str, Soup]] = field(default_factory=list)

    def add(self, name: str, paint: str, *soups: Soup) -> None:
        """One node of some triangles, metres, world space."""
        self.parts.append((name, paint, join(*soups)))

    def glb(self, name: str) -> bytes:
        """The whole room as a glTF 2.0 binary."""
        glb = GlbWriter()
        number = {paint: k for k, paint in enumerate(self.paints)}
        for paint, p in self.paints.items():
            glb.add("materials", _material(paint, p))
        for part, paint, soup in self.parts:
            primitive = glb.primitive(indexed(soup, CREASE_DEG, metres_per_tile=1.0))
            mesh = glb.add(
                "meshes", {"name": part, "primitives": [{**primitive, "material": number[paint]}]}
            )
            glb.node(part, mesh, (0.0, 0.0, 0.0), yaw=0.0, scale=1.0)
        extensions = ["KHR_materials_emissive_strength"]
        if any(paint.glass for paint in self.paints.values()):
            extensions += GLASS_EXTENSIONS
        return glb.bytes(extensions, name, "tools/make_rooms.py")


def _material(name: str, paint: Paint) -> dict[str, Any]:
    entry: dict[str, Any] = {
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*paint.color, 1.0],
            "metallicFactor": paint.metallic,
            "roughnessFactor": paint.roughness,
        },
    }
    strength = max(paint.glow)
    if strength > 0.0:
        entry["emissiveFactor"] = [c / strength for c in paint.glow]
        entry["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
    if paint.glass is not None:
        entry["extensions"] = glass_extensions(paint.glass)
    return entry


def glass_extensions(glass: Glass) -> dict[str, Any]:
    """The extensions of a glTF material that is wholly transmissive."""
    extensions: dict[str, Any] = {
        "KHR_materials_transmission": {"transmissionFactor": 1.0},
        "KHR_materials_ior": {"ior": 1.5},
    }
    if glass.thickness > 0.0:
        volume: dict[str, Any] = {"thicknessFactor": glass.thickness}
        if glass.attenuation is not None:
            color, distance = glass.attenuation
            volume |= {"attenuationColor": color, "attenuationDistance": distance}
        extensions["KHR_materials_volume"] = volume
    return extensions


def span(low: Sequence[float], high: Sequence[float]) -> Soup:
    """The solid box from one corner to the opposite one."""
    a, b = np.array(low, np.float64), np.array(high, np.float64)
    return box((b - a).tolist(), ((a + b) / 2.0).tolist())


def face(a: Point, b: Point, c: Point, d: Point) -> Soup:
    """A flat quadrilateral; its corners go round counter-clockwise where it is seen from."""
    corners = np.array([a, b, c, d], np.float64)
    return triangles(corners[[[0, 1, 2], [0, 2, 3]]])


def ball(radius: float, centre: Point, rings: int = SPHERE_RINGS) -> Soup:
    """A sphere."""
    turn = np.linspace(-np.pi / 2.0, np.pi / 2.0, rings + 1)
    profile = [(radius * float(max(np.cos(t), 0.0)), radius * float(np.sin(t))) for t in turn]
    profile[0], profile[-1] = (0.0, -radius), (0.0, radius)
    return revolve(profile, 2 * rings).moved(*centre)


def torus(major: float, minor: float, centre: Point) -> Soup:
    """A ring that lies flat."""
    turn = np.linspace(0.0, 2.0 * np.pi, SPHERE_RINGS + 1)
    around = np.linspace(0.0, 2.0 * np.pi, 2 * SPHERE_RINGS + 1)
    reach = major + minor * np.cos(turn)
    points = np.stack(
        [
            np.outer(np.cos(around), reach),
            np.outer(np.ones_like(around), minor * np.sin(turn)),
            -np.outer(np.sin(around), reach),
        ],
        axis=-1,
    )
    points[-1], points[:, -1] = points[0], points[:, 0]
    return sheet(points).moved(*centre)
