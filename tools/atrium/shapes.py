"""The closed solids that the atrium is made of."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise, product

import numpy as np
from numpy.typing import NDArray

from atrium.mesh import F64, Soup, join, sheet, triangles

STONE_TILE = 2.0
"""Metres that one tile of the stone texture covers; revolved shapes close their seam on it."""


def box(size: Sequence[float], centre: Sequence[float], chamfer: float = 0.0) -> Soup:
    """An axis-aligned box, metres; with a chamfer its edges catch light."""
    half, middle = np.array(size) / 2.0, np.array(centre)
    faces: list[F64] = []

    def corner(signs: NDArray[np.int64], flat: int) -> F64:
        inset = np.where(np.arange(3) == flat, 0.0, chamfer)
        return np.asarray(signs * (half - inset))

    def add(*points: F64) -> None:
        outline = np.array(points)
        normal = np.cross(outline[1] - outline[0], outline[2] - outline[0])
        ordered = outline if normal @ outline.mean(axis=0) > 0 else outline[::-1]
        faces.extend(ordered[[0, k, k + 1]] for k in range(1, len(ordered) - 1))

    for axis, side in product(range(3), (-1, 1)):
        b, c = (axis + 1) % 3, (axis + 2) % 3
        signs = np.empty((4, 3), dtype=np.int64)
        signs[:, axis], signs[:, b], signs[:, c] = side, [-1, 1, 1, -1], [-1, -1, 1, 1]
        add(*(corner(s, axis) for s in signs))
        if chamfer > 0.0:
            for other in (-1, 1):  # the edge between this face and the next axis' face
                ends = np.empty((2, 3), dtype=np.int64)
                ends[:, axis], ends[:, b], ends[:, c] = side, other, [-1, 1]
                add(
                    corner(ends[0], axis),
                    corner(ends[1], axis),
                    corner(ends[1], b),
                    corner(ends[0], b),
                )
    if chamfer > 0.0:
        for octant in np.array(list(product((-1, 1), repeat=3))):
            add(*(corner(octant, axis) for axis in range(3)))
    return triangles(np.array(faces) + middle)


def revolve(profile: Sequence[tuple[float, float]], segments: int) -> Soup:
    """A profile (radius, height), bottom to top, turned about y; closed if it ends at radius 0."""
    line = np.array(profile, dtype=np.float64)
    angle = np.linspace(0.0, 2.0 * np.pi, segments + 1)
    circle = np.stack([np.cos(angle), np.zeros_like(angle), -np.sin(angle)], axis=1)
    circle[-1] = circle[0]
    points = line[:, None, 0:1] * circle[None] + line[:, None, 1:2] * np.array([0.0, 1.0, 0.0])
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    tiles = max(1.0, np.round(2.0 * np.pi * line[:, 0].max() / STONE_TILE))
    u = np.broadcast_to(angle[None] / (2.0 * np.pi) * tiles * STONE_TILE, points.shape[:2])
    v = np.broadcast_to(-length[:, None], points.shape[:2])
    uv = np.stack([u, v], axis=-1)
    return sheet(points.swapaxes(0, 1), uv.swapaxes(0, 1))


def ring(profile: Sequence[tuple[float, float]], half_x: float, half_z: float) -> Soup:
    """A closed profile swept round a rectangle, mitred: (metres out of the rectangle, height).

    The profile is listed counter-clockwise in the plane (outwards, up).
    """
    line = np.array([*profile, profile[0]], dtype=np.float64)
    girth = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    sides: list[Soup] = []
    corners = [(1, 1), (1, -1), (-1, -1), (-1, 1), (1, 1)]
    for (ax, az), (bx, bz) in pairwise(corners):
        ends = [
            np.stack([sx * (half_x + line[:, 0]), line[:, 1], sz * (half_z + line[:, 0])], axis=1)
            for sx, sz in ((ax, az), (bx, bz))
        ]
        along = 2 if ax == bx else 0
        uv = np.stack(
            [np.stack([end[:, along], -girth], axis=1) for end in ends],
        )
        sides.append(sheet(np.stack(ends), uv))
    return join(*sides)


def thick_strip(inner: F64, outer: F64, depth: float) -> Soup:
    """The solid between two polylines (N, 2) in xy, extruded over z = -depth/2 .. depth/2.

    Both run the same way, with `outer` on their left; the ends are closed.
    """
    z = depth / 2.0

    def at(line: F64, height: float) -> F64:
        return np.concatenate([line, np.full((len(line), 1), height)], axis=1)

    outline = np.concatenate([inner, outer[::-1], inner[:1]])
    front = sheet(np.stack([at(inner, z), at(outer, z)], axis=1))
    back = sheet(np.stack([at(outer, -z), at(inner, -z)], axis=1))
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(outline, axis=0), axis=1))])
    rim_uv = np.stack(
        [np.stack([np.full_like(length, side), -length], axis=1) for side in (-z, z)], axis=1
    )
    rim = sheet(np.stack([at(outline, -z), at(outline, z)], axis=1), rim_uv)
    return join(front, back, rim)


def arc(radius: float, segments: int, start: float = np.pi, stop: float = 0.0) -> F64:
    """Points (segments + 1, 2) of a circle about the origin, from one angle to another, radians."""
    angle = np.linspace(start, stop, segments + 1)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def arch_panel(width: float, height: float, radius: float, depth: float, segments: int) -> Soup:
    """A wall over a round arch: x = -width/2 .. width/2, y = 0 (springing) .. height."""
    corner = np.arctan2(height, width / 2.0)
    upper = np.linspace(corner, np.pi - corner, segments // 2 + 1)
    side = np.linspace(0.0, corner, segments // 4 + 1)[:-1]
    angle = np.concatenate([side, upper, np.pi - side[::-1]])
    ray = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    reach = np.minimum(
        width / 2.0 / np.maximum(np.abs(ray[:, 0]), 1e-12),
        height / np.maximum(np.abs(ray[:, 1]), 1e-12),
    )
    return thick_strip((radius * ray)[::-1], (reach[:, None] * ray)[::-1], depth)


def voussoirs(inner: float, outer: float, depth: float, count: int, gap: float) -> list[Soup]:
    """The wedge stones of a round arch, left to right, `gap` metres of joint between two."""
    edges = np.linspace(np.pi, 0.0, count + 1)
    half_joint = gap / (inner + outer)
    return [
        thick_strip(
            arc(inner, 3, start - half_joint, stop + half_joint),
            arc(outer, 3, start - half_joint, stop + half_joint),
            depth,
        )
        for start, stop in pairwise(edges)
    ]


def groin_vault(side: float, height: float, segments: int, rows: int) -> Soup:
    """A square block over two crossing barrels: y = 0 (springing) .. height, closed.

    The barrels' radius is side/2, so the block stands on its four corners alone.
    """
    radius = side / 2.0
    angle = np.linspace(-np.pi / 2.0, np.pi / 2.0, segments + 1)
    z, crown = radius * np.sin(angle), radius * np.cos(angle)
    z[[0, -1]], crown[[0, -1]] = (-radius, radius), 0.0
    share = np.linspace(0.0, 1.0, rows + 1)
    x = np.abs(z)[:, None] * (1.0 - share) + radius * share
    under = np.stack(np.broadcast_arrays(x, crown[:, None], z[:, None]), axis=-1)
    arc_length = radius * angle
    under_uv = np.stack(np.broadcast_arrays(x, arc_length[:, None]), axis=-1)
    bottom = sheet(under, under_uv).flipped()
    top_edge = np.stack([np.full_like(z, radius), np.full_like(z, height), z], axis=1)
    lunette = sheet(np.stack([top_edge, under[:, -1]], axis=1))
    centre = np.broadcast_to(np.array([0.0, height, 0.0]), top_edge[1:].shape)
    top = triangles(np.stack([centre, top_edge[1:], top_edge[:-1]], axis=1))
    quarter = join(bottom, lunette, top)
    return join(*(quarter.turned_y(k * np.pi / 2.0) for k in range(4)))
