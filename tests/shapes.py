"""Small meshes as (positions (N, 3) float32, indices (3T,) uint32), counter-clockwise outside."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Shape = tuple[npt.NDArray[np.float32], npt.NDArray[np.uint32]]


def quad(size: float = 1.0) -> Shape:
    """A square in the xz plane around the origin, facing +y."""
    h = size / 2
    positions = np.array([[-h, 0, h], [h, 0, h], [h, 0, -h], [-h, 0, -h]], np.float32)
    return positions, np.array([0, 1, 2, 0, 2, 3], np.uint32)


def box(size: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Shape:
    """A box around the origin, with vertices of its own for each face."""
    corners, faces = [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            normal, u = np.zeros(3), np.zeros(3)
            normal[axis], u[(axis + 1) % 3] = sign, 1.0
            v = np.cross(normal, u)
            first = len(corners) * 4
            corners.append([normal - u - v, normal + u - v, normal + u + v, normal - u + v])
            faces.append([first + k for k in (0, 1, 2, 0, 2, 3)])
    positions = np.array(corners).reshape(-1, 3) * (np.array(size) / 2)
    return positions.astype(np.float32), np.array(faces, np.uint32).reshape(-1)


def sphere(radius: float = 1.0, rings: int = 16) -> Shape:
    """A closed sphere of `rings` by 2·`rings` faces; its vertices are shared, but at the seam."""
    return _revolve(np.linspace(0.0, np.pi, rings + 1), 0.0, radius, 2 * rings)


def torus(major: float = 1.0, minor: float = 0.3, rings: int = 16) -> Shape:
    """A closed torus about the y axis."""
    return _revolve(np.linspace(0.0, 2.0 * np.pi, rings + 1), major, minor, 2 * rings)


def inward(shape: Shape) -> Shape:
    """The same surface seen from its other side."""
    positions, indices = shape
    return positions, indices.reshape(-1, 3)[:, ::-1].ravel().copy()


def _revolve(angles: npt.NDArray[np.float64], major: float, minor: float, segments: int) -> Shape:
    turn = np.linspace(0.0, 2.0 * np.pi, segments + 1)
    reach = major + minor * np.sin(angles)[:, None]
    reach[np.abs(reach) < 1e-12] = 0.0
    height = minor * np.cos(angles)[:, None] * np.ones_like(turn)
    points = np.stack([reach * np.cos(turn), height, -reach * np.sin(turn)], axis=-1)
    points[:, -1] = points[:, 0]  # the seam closes to the bit
    if major > 0.0:
        points[-1] = points[0]
    columns = segments + 1
    i, j = np.meshgrid(np.arange(len(angles) - 1), np.arange(segments), indexing="ij")
    a = i * columns + j
    faces = np.stack([a, a + columns, a + columns + 1, a, a + columns + 1, a + 1], axis=-1)
    triangles = faces.reshape(-1, 3)
    corners = points.reshape(-1, 3)[triangles]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    triangles = triangles[area > 1e-12 * minor**2]
    return points.reshape(-1, 3).astype(np.float32), triangles.reshape(-1).astype(np.uint32)
