"""Triangle soups and what turns them into indexed meshes with normals: numpy only."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]

WELD = 1e-5
"""Positions closer than this (m) are one vertex."""


@dataclass(frozen=True)
class Soup:
    """Loose triangles: `position` (T, 3, 3) in metres, `uv` (T, 3, 2) in metres of surface."""

    position: F64
    uv: F64

    @property
    def count(self) -> int:
        """Triangles."""
        return len(self.position)

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Soup:
        """The soup translated; its uv stay."""
        return Soup(self.position + np.array([x, y, z]), self.uv)

    def turned_y(self, angle: float) -> Soup:
        """The soup rotated about y by `angle` radians, x towards -z."""
        c, s = np.cos(angle), np.sin(angle)
        rotation = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
        return Soup(self.position @ rotation.T, self.uv)

    def flipped(self) -> Soup:
        """The soup with its faces turned over."""
        return Soup(self.position[:, ::-1], self.uv[:, ::-1])

    def box_mapped(self) -> Soup:
        """The soup with uv in metres along its dominant plane: level on walls, xz on floors."""
        face_normal = np.cross(
            self.position[:, 1] - self.position[:, 0], self.position[:, 2] - self.position[:, 0]
        )
        axis = np.abs(face_normal).argmax(axis=1)
        u_axis, v_axis = np.array([2, 0, 0])[axis], np.array([1, 2, 1])[axis]
        rows = np.arange(self.count)
        sign = np.sign(face_normal[rows, axis])
        u_sign = np.where(axis == 0, -sign, np.where(axis == 2, sign, 1.0))
        v_sign = np.where(axis == 1, sign, -1.0)
        u = self.position[rows, :, u_axis] * u_sign[:, None]
        v = self.position[rows, :, v_axis] * v_sign[:, None]
        return Soup(self.position, np.stack([u, v], axis=-1))


@dataclass(frozen=True)
class Mesh:
    """An indexed mesh: position, normal (N, 3), uv (N, 2), all float32; index (M,) uint32."""

    position: NDArray[np.float32]
    normal: NDArray[np.float32]
    uv: NDArray[np.float32]
    index: NDArray[np.uint32]

    @property
    def triangle_count(self) -> int:
        """Triangles."""
        return len(self.index) // 3


def join(*soups: Soup) -> Soup:
    """All triangles of `soups` as one soup."""
    return Soup(np.concatenate([s.position for s in soups]), np.concatenate([s.uv for s in soups]))


def triangles(position: F64, uv: F64 | None = None) -> Soup:
    """A soup of (T, 3, 3) positions; uv box-mapped where none are given; slivers dropped."""
    area = np.linalg.norm(
        np.cross(position[:, 1] - position[:, 0], position[:, 2] - position[:, 0]), axis=1
    )
    keep = area > WELD * WELD
    soup = Soup(position[keep], np.zeros((int(keep.sum()), 3, 2)) if uv is None else uv[keep])
    return soup.box_mapped() if uv is None else soup


def sheet(points: F64, uv: F64 | None = None) -> Soup:
    """The surface over a grid of points (U, V, 3); its front is where dP/dU x dP/dV points."""

    def split(g: F64) -> F64:
        a, b, c, d = g[:-1, :-1], g[1:, :-1], g[1:, 1:], g[:-1, 1:]
        both = np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)], axis=2)
        return both.reshape(-1, 3, g.shape[-1])

    return triangles(split(points), None if uv is None else split(uv))


def _weld_ids(position: F64) -> NDArray[np.int64]:
    """The same number for each corner at the same place: (T, 3)."""
    keys = np.round(position.reshape(-1, 3) / WELD).astype(np.int64)
    ids = np.unique(keys, axis=0, return_inverse=True)[1]
    return ids.reshape(position.shape[:2]).astype(np.int64)


def is_closed(soup: Soup) -> bool:
    """Whether every edge is walked as often one way as the other: no border, no flipped face."""
    ids = _weld_ids(soup.position)
    edges = np.concatenate([ids[:, [0, 1]], ids[:, [1, 2]], ids[:, [2, 0]]])
    span = int(ids.max()) + 1
    there = np.sort(edges[:, 0] * span + edges[:, 1])
    back = np.sort(edges[:, 1] * span + edges[:, 0])
    return bool(np.array_equal(there, back))


def volume(soup: Soup) -> float:
    """The enclosed volume of a closed soup, m^3; negative where its faces look inwards."""
    a, b, c = (soup.position[:, k] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def _corner_angles(position: F64) -> F64:
    """The triangles' inner angles, (3T,) radians: as weights they hide how quads are split."""
    there = np.roll(position, -1, axis=1) - position
    back = np.roll(position, 1, axis=1) - position
    sine = np.linalg.norm(np.cross(there, back), axis=-1)
    return np.asarray(np.arctan2(sine, np.einsum("tcj,tcj->tc", there, back)).ravel())


def indexed(soup: Soup, crease_degrees: float, metres_per_tile: float) -> Mesh:
    """Normals smoothed over edges flatter than the crease, equal corners welded.

    uv become texture coordinates: one tile every `metres_per_tile`.
    """
    scaled = np.cross(
        soup.position[:, 1] - soup.position[:, 0], soup.position[:, 2] - soup.position[:, 0]
    )
    unit = scaled / np.linalg.norm(scaled, axis=1, keepdims=True)
    ids = _weld_ids(soup.position).ravel()
    order = np.argsort(ids, kind="stable")
    starts = np.searchsorted(ids[order], np.arange(ids.max() + 2))
    angle = _corner_angles(soup.position)
    normal = np.empty((len(ids), 3))
    limit = np.cos(np.radians(crease_degrees)) - 1e-9
    for first, last in pairwise(starts):
        corners = order[first:last]
        faces = corners // 3
        near = unit[faces] @ unit[faces].T >= limit
        normal[corners] = near @ (unit[faces] * angle[corners, None])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    corner = np.concatenate(
        [soup.position.reshape(-1, 3), normal, soup.uv.reshape(-1, 2) / metres_per_tile], axis=1
    )
    _, pick, inverse = np.unique(
        np.round(corner, 5), axis=0, return_index=True, return_inverse=True
    )
    # Vertices in the order of first use, so that the file compresses and caches well.
    rank = np.empty(len(pick), dtype=np.int64)
    rank[np.argsort(pick)] = np.arange(len(pick))
    chosen = corner[np.sort(pick)].astype(np.float32)
    return Mesh(
        chosen[:, :3].copy(),
        chosen[:, 3:6].copy(),
        chosen[:, 6:].copy(),
        rank[inverse.ravel()].astype(np.uint32),
    )
