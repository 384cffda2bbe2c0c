"""Scenes of a few bodies for the octree's tests."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.passes.voxel.grid import Grid
from elemental.scene.model import Material, Mesh, Scene
from gpu.rig import IDENTITY, at, material, mesh, scene, sun, vector
from shapes import Shape, box, quad, sphere, torus

Array = npt.NDArray[Any]


def turned(axis: Array, angle: float, *, to: tuple[float, float, float] = (0, 0, 0)) -> Array:
    """world_from_local: a turn by ``angle`` radians about ``axis``, then a move."""
    axis = np.asarray(axis, np.float64) / np.linalg.norm(axis)
    quaternion = np.append(axis * np.sin(angle / 2), np.cos(angle / 2))
    return transforms.compose(
        np.array(to, np.float32), quaternion.astype(np.float32), np.ones(3, np.float32)
    )


TURNS = {
    "straight": IDENTITY,
    "turned": turned(vector(0.3, 1.0, 0.2), 0.6),
    "diagonal": turned(vector(0, 1, 0), np.pi / 4),
}
"""How a room may lie across the lattice: world_from_local by name."""


def facing(normal: Array) -> Array:
    """world_from_local: a turn that takes +y to ``normal``."""
    unit = np.asarray(normal, np.float64) / np.linalg.norm(normal)
    axis = np.cross([0.0, 1.0, 0.0], unit)
    if np.linalg.norm(axis) < 1e-9:
        axis = np.array([1.0, 0.0, 0.0])
    return turned(axis, float(np.arccos(np.clip(unit[1], -1.0, 1.0))))


def glowing(*radiance: float, **fields: Any) -> Material:
    """Black but for its own light."""
    emissive = np.resize(np.array(radiance, np.float32), 3)
    return material(base_color=vector(0, 0, 0, 1), emissive=emissive, **fields)


def colored(*rgb: float, **fields: Any) -> Material:
    return material(base_color=vector(*rgb, 1), **fields)


def part(shape: Shape, index: int, world_from_local: Array, **fields: Any) -> tuple[Mesh, Array]:
    """A mesh of the scene's material ``index``, placed."""
    return mesh(shape, index, **fields), world_from_local


def grid_with(offsets: Array, bounds: tuple[Array, Array], resolution: int = 64) -> Grid:
    """A grid whose regions' leaf levels differ from the resolution's by (8, 8, 8) [z, y, x]."""
    plain = Grid.fit(bounds, resolution)
    levels = plain.region_levels.astype(np.int64) + offsets
    return replace(plain, region_levels=levels.astype(np.uint32))


def jumble() -> Scene:
    """Thin and thick, straight and slanted, dark, coloured and glowing over seven decades."""
    return scene(
        part(quad(2.0), 0, at(0, -0.9, 0)),
        part(sphere(0.35), 1, at(-0.5, -0.3, 0.2), smooth=True),
        part(torus(0.4, 0.12), 2, turned(vector(1, 0.3, 0), 0.9, to=(0.45, 0.2, -0.2))),
        part(box((0.5, 0.04, 0.6)), 3, turned(vector(0.3, 0.2, 1), 0.5, to=(0.3, -0.5, 0.5))),
        part(box((0.1, 0.1, 0.1)), 4, at(-0.6, 0.5, -0.6)),
        part(box((0.2, 0.6, 0.2)), 5, turned(vector(0, 1, 0), 0.4, to=(-0.2, -0.2, -0.7))),
        materials=[
            colored(0.8, 0.8, 0.8),
            colored(0.9, 0.1, 0.05),
            colored(0.1, 0.7, 0.2),
            glowing(0.02, 0.05, 0.01),
            glowing(3000.0, 2000.0, 500.0),
            glowing(4.0, 0.5, 7.0),
        ],
        lights=[sun(vector(-0.4, -1.0, -0.3))],
    )
