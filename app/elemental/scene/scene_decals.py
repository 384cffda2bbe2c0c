"""A scene file's decals, and the materials that they project."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from elemental.scene.arrays import FloatArray
from elemental.scene.definitions import find_definition
from elemental.scene.materials import Material
from elemental.scene.model import Decal, Scene
from elemental.scene.scene_materials import valued
from elemental.scene.tables.decals import DecalTable


def stick(scene: Scene, tables: Sequence[DecalTable]) -> None:
    """Append the decals to the scene, and their materials; equal ones are one material.

    Raises InputError for an unknown definition, parameter, value or image.
    """
    images: dict[Path, int] = {}
    known: dict[str, int] = {}
    for number, table in enumerate(tables):
        name = table.name or f"decal{number}"
        look = json.dumps([table.shader, table.parameters], sort_keys=True, default=str)
        if look not in known:
            known[look] = len(scene.materials)
            scene.materials.append(_material(scene, table, name, f"decals[{number}]", images))
        scene.decals.append(
            Decal(
                name,
                known[look],
                box_matrix(table.position, table.direction, table.up, table.size),
                table.opacity,
                table.order,
                math.radians(table.fade_deg[0]),
                math.radians(table.fade_deg[1]),
                tuple(table.channels),
            )
        )


def _material(
    scene: Scene, table: DecalTable, name: str, field: str, images: dict[Path, int]
) -> Material:
    """A rough dielectric, but for what the table says."""
    material = Material(name, metallic=0.0, alpha_mode="blend")
    if table.shader is not None:
        folder = scene.path.parent
        definition = find_definition(table.shader, folder, scene.path, f"{field}.shader")
        material = material.with_definition(definition)
    return valued(material, table.parameters, scene, f"{field}.parameters", images)


def box_matrix(
    position: Sequence[float],
    direction: Sequence[float],
    up: Sequence[float],
    size: Sequence[float],
) -> FloatArray:
    """world_from_decal (4, 4): a box around `position` (m) of `size` (width, height, depth in m).

    Its z points against `direction`, its y towards `up`, which is not along it.
    """
    z = -np.array(direction, np.float64)
    z /= np.linalg.norm(z)
    x = np.cross(np.array(up, np.float64), z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1) * np.array(size)
    matrix[:3, 3] = position
    return matrix.astype(np.float32)
