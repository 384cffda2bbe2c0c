"""Matrices and their conventions: float32, column vectors, right-handed, y up, metres.

A matrix is a ``(4, 4) float32`` array `m` in row-major memory with ``p' = m @ p``, and is named by
composition: ``clip_from_world = clip_from_view @ view_from_world``. A camera looks down its -z.
Clip space is OpenGL's: z/w from -1 (near) to 1 (far).

pyrr is wrapped here and nowhere else: it works with row vectors and returns float64 (or integers,
for integer inputs), so results are transposed and cast.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from pyrr import matrix44

Matrix: TypeAlias = npt.NDArray[np.float32]
"""(4, 4) float32."""
Vec3Like: TypeAlias = Sequence[float] | npt.NDArray[Any]

PARALLEL_SINE = 1e-4
"""Sine of the angle below which a view direction counts as parallel to the up vector [inferred:
far above float32 rounding, far below what an artist places on purpose]."""


def identity() -> Matrix:
    """The (4, 4) float32 identity."""
    return np.eye(4, dtype=np.float32)


def look_at(eye: Vec3Like, target: Vec3Like, up: Vec3Like = (0.0, 1.0, 0.0)) -> Matrix:
    """view_from_world of a camera at `eye` (m) that looks at `target`.

    Where the view direction is parallel to `up`, the axis most perpendicular to it stands in.
    Raises ValueError if `eye` and `target` coincide.
    """
    e, t, u = (np.asarray(v, np.float64) for v in (eye, target, up))
    forward = t - e
    length = np.linalg.norm(forward)
    if not length > 0.0:
        raise ValueError("eye and target coincide")
    sine = np.linalg.norm(np.cross(forward, u))
    if sine <= PARALLEL_SINE * length * np.linalg.norm(u):
        u = np.eye(3)[np.argmin(np.abs(forward))]
    return _from_pyrr(matrix44.create_look_at(e, t, u))


def perspective(fov_y: float, aspect: float, near: float, far: float = math.inf) -> Matrix:
    """clip_from_view of a perspective camera.

    `fov_y` in radians over the whole height, `aspect` is width / height, `near` and `far` in m.
    An infinite `far` gives the limit of the finite matrix.
    """
    if math.isinf(far):
        m = perspective(fov_y, aspect, near, 2.0 * near)
        m[2, 2], m[2, 3] = -1.0, -2.0 * near
        return m
    degrees = math.degrees(fov_y)
    return _from_pyrr(matrix44.create_perspective_projection(degrees, aspect, near, far))


def orthographic(
    left: float, right: float, bottom: float, top: float, near: float, far: float
) -> Matrix:
    """clip_from_view of the view-space box left..right, bottom..top, near..far along -z."""
    bounds = (float(v) for v in (left, right, bottom, top, near, far))
    return _from_pyrr(matrix44.create_orthogonal_projection(*bounds))


def rotation(quaternion_xyzw: Vec3Like) -> Matrix:
    """The rotation by a quaternion in glTF's order x, y, z, w; it is normalized first.

    Raises ValueError for a quaternion of length 0.
    """
    length = math.hypot(*(float(c) for c in quaternion_xyzw))
    if not length > 0.0:
        raise ValueError("a rotation quaternion has length 0")
    # pyrr's own is for column vectors, unlike its other matrices, and takes 0.1 ms.
    x, y, z, w = (float(c) / length for c in quaternion_xyzw)
    m = identity()
    m[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return m


def compose(translation: Vec3Like, quaternion_xyzw: Vec3Like, scale: Vec3Like) -> Matrix:
    """translation @ rotation @ scale, glTF's order: the scale acts first."""
    m = rotation(quaternion_xyzw)
    m[:3, :3] *= np.asarray(scale, np.float32)
    m[:3, 3] = translation
    return m


def inverse(m: Matrix) -> Matrix:
    """The inverse, computed in float64. Raises numpy.linalg.LinAlgError for a singular matrix."""
    return np.linalg.inv(m.astype(np.float64)).astype(np.float32)


def transform_points(m: Matrix, points: npt.NDArray[Any]) -> npt.NDArray[np.float32]:
    """`m` applied to (N, 3) points, divided by w where `m` projects. (N, 3) float32."""
    p = np.asarray(points, np.float64) @ m[:3, :3].astype(np.float64).T + m[:3, 3]
    if np.array_equal(m[3], (0.0, 0.0, 0.0, 1.0)):
        return p.astype(np.float32)
    w = np.asarray(points, np.float64) @ m[3, :3].astype(np.float64) + m[3, 3]
    projected: npt.NDArray[np.float32] = (p / w[..., None]).astype(np.float32)
    return projected


def transform_vectors(m: Matrix, vectors: npt.NDArray[Any]) -> npt.NDArray[np.float32]:
    """The linear part of `m` applied to (N, 3) directions; lengths are kept as they come out."""
    v = np.asarray(vectors, np.float64) @ m[:3, :3].astype(np.float64).T
    return v.astype(np.float32)


def normal_matrix(m: Matrix) -> npt.NDArray[np.float32]:
    """(3, 3) inverse transpose of `m`'s linear part: takes normals where `m` takes points."""
    return np.linalg.inv(m[:3, :3].astype(np.float64)).T.astype(np.float32)


def _from_pyrr(m: npt.NDArray[Any]) -> Matrix:
    return np.ascontiguousarray(m.T, dtype=np.float32)
