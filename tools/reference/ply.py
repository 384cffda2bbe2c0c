"""Binary PLY files, the way triangles reach mitsuba."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from elemental.core import transforms
from elemental.scene.model import FloatArray, IndexArray, Mesh, Scene

SHEET_GAP = 1e-5
"""Half the distance between the two sides of a sheet, as a part of its size."""


@dataclass(frozen=True)
class WorldMesh:
    """Everything of one material in world space: (N, 3), (N, 3), (N, 2), (N, 4) uint8, (T, 3)."""

    positions: FloatArray
    normals: FloatArray
    uv: FloatArray
    colors: np.ndarray[tuple[int, ...], np.dtype[np.uint8]]
    triangles: IndexArray


def world_meshes(scene: Scene, uv_set: dict[int, int]) -> dict[int, WorldMesh]:
    """The scene's instances merged by material; `uv_set` says which set a material reads (0, 1)."""
    parts: dict[int, list[WorldMesh]] = {}
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        placed = _placed(mesh, instance.world_from_local, uv_set.get(mesh.material, 0))
        parts.setdefault(mesh.material, []).append(placed)
    return {material: _merged(found) for material, found in parts.items()}


def _placed(mesh: Mesh, world_from_local: FloatArray, uv_set: int) -> WorldMesh:
    normals = mesh.normals @ np.linalg.inv(world_from_local[:3, :3].astype(np.float64))
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return WorldMesh(
        transforms.transform_points(world_from_local, mesh.positions),
        (normals / np.maximum(length, 1e-30)).astype(np.float32),
        mesh.uv1 if uv_set else mesh.uv0,
        mesh.colors,
        mesh.indices.reshape(-1, 3),
    )


def two_sheets(mesh: WorldMesh) -> tuple[WorldMesh, WorldMesh]:
    """A mesh and its back side, a hair's breadth apart, so that a ray meets what it faces first."""
    size = float(np.ptp(mesh.positions, axis=0).max())
    shift = (SHEET_GAP * size * mesh.normals).astype(np.float32)
    back = mesh.triangles[:, ::-1]
    return (
        replace(mesh, positions=mesh.positions + shift),
        replace(mesh, positions=mesh.positions - shift, normals=-mesh.normals, triangles=back),
    )


def _merged(parts: list[WorldMesh]) -> WorldMesh:
    starts = np.cumsum([0, *(len(p.positions) for p in parts[:-1])])
    return WorldMesh(
        np.concatenate([p.positions for p in parts]),
        np.concatenate([p.normals for p in parts]),
        np.concatenate([p.uv for p in parts]),
        np.concatenate([p.colors for p in parts]),
        np.concatenate([p.triangles + s for p, s in zip(parts, starts, strict=True)]).astype("<u4"),
    )


def write_ply(path: Path, mesh: WorldMesh) -> None:
    """Write little-endian PLY with normals, uv and `color` (linear, 0..1) at each vertex."""
    names = ("x", "y", "z", "nx", "ny", "nz", "u", "v", "r", "g", "b")
    colors = mesh.colors[:, :3].astype(np.float32) / 255.0
    vertices = np.concatenate([mesh.positions, mesh.normals, mesh.uv, colors], axis=1)
    faces = np.empty(len(mesh.triangles), dtype=[("count", "u1"), ("index", "<u4", 3)])
    faces["count"], faces["index"] = 3, mesh.triangles
    header = [
        "ply",
        "format binary_little_endian 1.0",
        f"element vertex {len(vertices)}",
        *(f"property float {name}" for name in names),
        f"element face {len(faces)}",
        "property list uchar uint vertex_indices",
        "end_header\n",
    ]
    body = vertices.astype("<f4").tobytes() + faces.tobytes()
    path.write_bytes("\n".join(header).encode() + body)
