"""Tangent frames for normal maps, after MikkTSpace [Mikkelsen08], vectorized.

[Mikkelsen08]: Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008, and the code that
glTF 2.0 (3.7.2.1) names as the default for missing tangents. Kept from it: vertices that agree in
position, normal and texture coordinate share a frame; frames of mirrored texture mappings stay
apart, splitting vertices; triangles count by their angle at the vertex, measured in the vertex's
own tangent plane. Left out: two fans of triangles that touch in one vertex alone share its frame.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.scene.model import FloatArray, Mesh

F64 = npt.NDArray[np.float64]
I64 = npt.NDArray[np.int64]

MIN_UV_SINE = 1e-12
"""A triangle whose texture area is below this part of its squared longest texture edge has no
tangent of its own [inferred]."""

HASH_MULTIPLIERS = np.array(
    [0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x27D4EB2F165667C5,
     0x85EBCA77C2B2AE63, 0xD6E8FEB86659FD93, 0xA0761D6478BD642F, 0xE7037ED1A0B428DB],
    np.uint64,
)  # fmt: skip


def mikktspace_tangents(mesh: Mesh, uv: FloatArray) -> Mesh:
    """The mesh with tangents for the texture coordinates `uv` (N, 2) float32.

    Vertices between mirrored halves of a mapping are split; the copies follow the others.
    w is +1 where the mapping is not mirrored, in glTF's texture space with v downwards.
    """
    triangles = mesh.indices.reshape(-1, 3).astype(np.int64)
    tangent, side = _triangle_tangents(mesh, uv, triangles)
    mesh, uv, corner_vertex, corner_side = _split_mirrored(mesh, uv, triangles, side)
    normals = mesh.normals[corner_vertex].astype(np.float64)
    along = _perpendicular(np.repeat(tangent, 3, axis=0), normals)
    weight = _corner_angles(mesh.positions[triangles], normals.reshape(-1, 3, 3))
    group = _weld(mesh, uv)[corner_vertex] * 2 + (corner_side > 0)
    sums = np.stack([_summed(group, along[:, k] * weight) for k in range(3)], axis=1)
    frame = _perpendicular(sums[group], normals)
    tangents = any_tangents(mesh.normals)
    has_frame = frame.any(axis=1)
    tangents[corner_vertex[has_frame], :3] = frame[has_frame]
    tangents[corner_vertex, 3] = np.where(corner_side < 0, -1.0, 1.0)
    return replace(mesh, tangents=tangents)


def any_tangents(normals: FloatArray) -> FloatArray:
    """(N, 4) float32 unit tangents perpendicular to (N, 3) unit normals, w = 1.

    The branchless basis of Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017.
    """
    x, y, z = normals.T
    sign = np.copysign(np.float32(1.0), z)
    a = -1.0 / (sign + z)
    tangents = np.stack([1.0 + sign * x * x * a, sign * x * y * a, -sign * x, np.ones_like(x)], 1)
    return tangents.astype(np.float32)


def _triangle_tangents(mesh: Mesh, uv: FloatArray, triangles: I64) -> tuple[F64, I64]:
    """Per triangle: direction of growing u (T, 3), and +1, -1 (mirrored) or 0 (no texture area)."""
    p = mesh.positions.astype(np.float64)[triangles]
    t = uv.astype(np.float64)[triangles]
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    d1, d2 = t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]
    area = d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]
    longest2 = np.maximum((d1 * d1).sum(axis=1), (d2 * d2).sum(axis=1))
    # Counter-clockwise triangles turn clockwise in a texture space whose v points down.
    side = np.where(np.abs(area) > MIN_UV_SINE * longest2, -np.sign(area), 0.0)
    direction = (e1 * d2[:, 1:] - e2 * d1[:, 1:]) * np.sign(area)[:, None]
    return _normalized(direction) * (side != 0.0)[:, None], side.astype(np.int64)


def _split_mirrored(
    mesh: Mesh, uv: FloatArray, triangles: I64, side: I64
) -> tuple[Mesh, FloatArray, I64, I64]:
    """Give vertices that mirrored and plain triangles share a copy for the mirrored ones.

    Returns mesh, uv, and per corner (3T,) its vertex and its side. A triangle without a side takes
    that of its vertices.
    """
    count = len(mesh.positions)
    corner_vertex, corner_side = triangles.reshape(-1), np.repeat(side, 3)
    is_plain, is_mirrored = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
    is_plain[corner_vertex[corner_side > 0]] = True
    is_mirrored[corner_vertex[corner_side < 0]] = True
    fallback = np.where(is_mirrored & ~is_plain, -1, 1)
    corner_side = np.where(corner_side == 0, fallback[corner_vertex], corner_side)
    shared = np.flatnonzero(is_plain & is_mirrored)
    if not len(shared):
        return mesh, uv, corner_vertex, corner_side
    copy_of = np.zeros(count, np.int64)
    copy_of[shared] = count + np.arange(len(shared))
    moves = (corner_side < 0) & (copy_of[corner_vertex] > 0)
    corner_vertex = np.where(moves, copy_of[corner_vertex], corner_vertex)
    order = np.concatenate([np.arange(count), shared])
    split = replace(
        mesh,
        positions=mesh.positions[order],
        normals=mesh.normals[order],
        uv0=mesh.uv0[order],
        uv1=mesh.uv1[order],
        colors=mesh.colors[order],
        indices=corner_vertex.astype(np.uint32),
        influences=None if mesh.influences is None else mesh.influences.take(order),
        morphs=None if mesh.morphs is None else mesh.morphs.take(order),
    )
    return split, uv[order], corner_vertex, corner_side


def _weld(mesh: Mesh, uv: FloatArray) -> I64:
    """(N,) the same number for vertices equal in position, normal and texture coordinate."""
    rows = np.concatenate([mesh.positions, mesh.normals, uv], axis=1) + np.float32(0.0)  # -0 -> 0
    bits = np.ascontiguousarray(rows, np.float32).view(np.uint32).astype(np.uint64)
    hashed = np.bitwise_xor.reduce((bits + np.uint64(1)) * HASH_MULTIPLIERS, axis=1)
    _, first, group = np.unique(hashed, return_index=True, return_inverse=True)
    if not np.array_equal(rows[first][group], rows):  # two rows of one hash
        _, group = np.unique(rows, axis=0, return_inverse=True)
    return group.reshape(-1).astype(np.int64)


def _corner_angles(corners: FloatArray, normals: F64) -> F64:
    """(3T,) angles of (T, 3, 3) corners between their edges, seen along the corners' normals."""
    p = corners.astype(np.float64)
    to_next = _perpendicular(np.roll(p, -1, axis=1) - p, normals)
    to_last = _perpendicular(np.roll(p, 1, axis=1) - p, normals)
    cosine = np.einsum("ijk,ijk->ij", to_next, to_last)
    angles: F64 = np.arccos(np.clip(cosine, -1.0, 1.0)).reshape(-1)
    return angles


def _summed(group: I64, values: F64) -> F64:
    return np.bincount(group, values).astype(np.float64)


def _perpendicular(vectors: F64, normals: F64) -> F64:
    """Unit parts of the vectors perpendicular to the unit normals; a parallel one becomes 0."""
    off = (vectors * normals).sum(axis=-1, keepdims=True)
    return _normalized(vectors - off * normals)


def _normalized(vectors: npt.NDArray[Any]) -> F64:
    length = np.sqrt((vectors * vectors).sum(axis=-1, keepdims=True))
    unit: F64 = vectors / np.where(length > 0.0, length, 1.0)
    return unit
