"""Boxes around meshes that move, bend and morph, from a few numbers of each mesh."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from elemental.scene.model import Mesh
from elemental.scene.motion import F32, F64

Box = tuple[F64, F64]
"""(low, high), each (3,) float64 m."""


class MeshBoxes:
    """What the world box of a mesh under any pose follows from: larger than need be, never smaller.

    A skinned vertex lies among the places that each of its joints alone would give it, so the boxes
    of the joints' vertices, each moved by its joint, hold the mesh.
    """

    def __init__(self, mesh: Mesh) -> None:
        self._joints: npt.NDArray[np.int64] = np.empty(0, np.int64)
        positions = mesh.positions.astype(np.float64)
        held = [positions]
        if mesh.influences is not None:
            used = mesh.influences.weights > 0.0
            self._joints = np.unique(mesh.influences.joints[used]).astype(np.int64)
            holds = [((mesh.influences.joints == j) & used).any(axis=1) for j in self._joints]
            held += [positions[vertices] for vertices in holds]
        self._low = np.array([points.min(axis=0) for points in held])
        self._high = np.array([points.max(axis=0) for points in held])
        self._deltas: Box | None = None
        if mesh.morphs is not None:
            deltas = mesh.morphs.positions.astype(np.float64)
            self._deltas = deltas.min(axis=1), deltas.max(axis=1)

    def around(self, worlds: F32, joints: F32 | None = None, weights: F32 | None = None) -> Box:
        """The box that holds the mesh in all of S poses.

        worlds (S, 4, 4); joints (S, J, 4, 4) of a skinned mesh, in place of them; weights (S, T).
        """
        low, high = self._low[None], self._high[None]
        if self._deltas is not None and weights is not None:
            w = weights.astype(np.float64)[:, :, None]
            ends = w * self._deltas[0], w * self._deltas[1]
            low = low + np.minimum(*ends).sum(axis=1)[:, None]
            high = high + np.maximum(*ends).sum(axis=1)[:, None]
        if joints is not None and len(self._joints):
            matrices, low, high = joints[:, self._joints], low[:, 1:], high[:, 1:]
        else:
            matrices, low, high = worlds[:, None], low[:, :1], high[:, :1]
        m = matrices.astype(np.float64)
        center = np.einsum("snij,snj->sni", m[..., :3, :3], _like((low + high) / 2, m))
        center += m[..., :3, 3]
        reach = np.einsum("snij,snj->sni", np.abs(m[..., :3, :3]), _like((high - low) / 2, m))
        return (center - reach).min(axis=(0, 1)), (center + reach).max(axis=(0, 1))


def _like(points: F64, matrices: F64) -> F64:
    """(S or 1, n, 3) points for each of the (S, n, 4, 4) matrices."""
    return np.broadcast_to(points, (*matrices.shape[:2], 3))
