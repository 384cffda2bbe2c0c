"""What a transform says of the thing that it places: its direction, its frame, its volume."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

SINGULAR_VOLUME = 1e-9
"""Least volume of a transformed unit cube, as a part of its edges' product, that still counts as
three-dimensional [inferred]."""
SHORTEST_EDGE = 1e-15
"""Least length of such an edge: float32 still holds the inverse's cube [inferred]."""


def singular(matrices: npt.NDArray[Any]) -> npt.NDArray[np.bool_]:
    """(...,) bool: which of the (..., 4, 4) matrices flatten what they place."""
    linear = matrices[..., :3, :3].astype(np.float64)
    edges = np.linalg.norm(linear, axis=-2)
    short = edges.min(axis=-1) < SHORTEST_EDGE
    unit = linear / np.where(short[..., None], 1.0, edges)[..., None, :]
    flat = np.abs(np.linalg.det(unit)) < SINGULAR_VOLUME
    return np.asarray(short | flat)


def mirrors(matrices: npt.NDArray[Any]) -> npt.NDArray[np.bool_]:
    """(...,) bool: which of the (..., 4, 4) matrices turn left hands into right ones."""
    linear = matrices[..., :3, :3].astype(np.float64)
    return np.asarray(np.linalg.det(linear) < 0.0)


def forward(world_from_local: npt.NDArray[Any]) -> npt.NDArray[np.float32]:
    """-z of a node in the world, (3,) float32 unit: where its light shines and its camera looks."""
    axis = -world_from_local[:3, 2].astype(np.float64)
    length = float(np.linalg.norm(axis))
    unit = axis / length if length > 0.0 else np.array([0.0, 0.0, -1.0])
    return unit.astype(np.float32)


def rigid(world_from_local: npt.NDArray[Any]) -> npt.NDArray[np.float32]:
    """The transform without scale, mirroring or shear; -z keeps its direction, y its half plane."""
    z, y = world_from_local[:3, 2].astype(np.float64), world_from_local[:3, 1].astype(np.float64)
    x = np.cross(y, z)
    if not (np.linalg.norm(x) > 0.0 and np.isfinite(x).all()):
        x, z = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    x /= np.linalg.norm(x)
    z /= np.linalg.norm(z)
    frame = np.eye(4, dtype=np.float32)
    frame[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    frame[:3, 3] = world_from_local[:3, 3]
    return frame
