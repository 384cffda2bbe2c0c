"""From what a file holds of a primitive to a whole `Mesh`: cleaning, normals, tangents."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.scene.model import ByteArray, FloatArray, IndexArray, Mesh
from elemental.scene.motion import Influences, Morphs
from elemental.scene.tangents import any_tangents, mikktspace_tangents

DEGENERATE_SINE = 1e-8
"""A triangle whose height is less than this part of its longest edge has no area [inferred: below
the rounding of float32 coordinates, 6e-8, nothing is left of it]."""


@dataclass
class Primitive:
    """A triangle list as read: positions (N, 3) finite float32, indices (3T,); None = absent.

    Normals, tangents and texture coordinates may hold anything, NaN included.
    """

    positions: FloatArray
    indices: IndexArray
    normals: FloatArray | None = None
    tangents: FloatArray | None = None
    uv0: FloatArray | None = None
    uv1: FloatArray | None = None
    colors: ByteArray | None = None
    influences: Influences | None = None
    morphs: Morphs | None = None


VERTEX_ARRAYS = ("positions", "normals", "tangents", "uv0", "uv1", "colors")


def drop_degenerate(primitive: Primitive) -> tuple[Primitive, int]:
    """The primitive without its zero-area triangles, and how many those were."""
    a, b, c = _corners(primitive)
    cross = np.cross(b - a, c - a)
    edges = np.stack([b - a, c - b, a - c])
    longest2 = np.einsum("ijk,ijk->ij", edges, edges).max(axis=0)
    height2 = np.einsum("ij,ij->i", cross, cross)
    keep = height2 > (DEGENERATE_SINE * longest2) ** 2
    dropped = len(keep) - int(keep.sum())
    if not dropped:
        return primitive, 0
    indices = primitive.indices.reshape(-1, 3)[keep].reshape(-1)
    return replace(primitive, indices=indices), dropped


def drop_unused_vertices(primitive: Primitive) -> Primitive:
    """The primitive with only the vertices that its triangles use, in their order."""
    used = np.zeros(len(primitive.positions), np.bool_)
    used[primitive.indices] = True
    if used.all():
        return primitive
    renumbered = (np.cumsum(used) - 1).astype(np.uint32)
    return replace(_take(primitive, np.flatnonzero(used)), indices=renumbered[primitive.indices])


def complete(primitive: Primitive, name: str, material: int, tangent_uv_set: int | None) -> Mesh:
    """A `Mesh` with every array, from a primitive without zero-area triangles.

    Missing normals become flat ones, as glTF 2.0 (3.7.2.1) asks, by giving each triangle vertices
    of its own; zero or non-finite ones the area-weighted average of their triangles. Missing
    tangents follow MikkTSpace over uv set `tangent_uv_set`; where nothing reads them (None) or
    there are no such coordinates, they are any unit vectors perpendicular to the normals.
    """
    if primitive.normals is None:
        primitive = _with_flat_normals(primitive)
    else:
        primitive = replace(primitive, normals=_repaired_normals(primitive, primitive.normals))
    count = len(primitive.positions)
    uv0, uv1 = (_texture_coordinates(uv, count) for uv in (primitive.uv0, primitive.uv1))
    normals, indices = primitive.normals, primitive.indices
    assert normals is not None
    colors = primitive.colors
    mesh = Mesh(
        name=name,
        positions=primitive.positions,
        normals=normals,
        tangents=np.empty((0, 4), np.float32),
        uv0=uv0,
        uv1=uv1,
        colors=np.full((count, 4), 255, np.uint8) if colors is None else colors,
        indices=indices,
        material=material,
        influences=primitive.influences,
        morphs=primitive.morphs,
    )
    if primitive.tangents is not None:
        mesh.tangents = _repaired_tangents(primitive.tangents, normals)
    elif tangent_uv_set is None or (primitive.uv0, primitive.uv1)[tangent_uv_set] is None:
        mesh.tangents = any_tangents(normals)
    else:
        mesh = mikktspace_tangents(mesh, (uv0, uv1)[tangent_uv_set])
    return mesh


def mirrored(mesh: Mesh) -> Mesh:
    """The mesh for an instance that mirrors it: winding and tangent handedness reversed."""
    indices = np.ascontiguousarray(mesh.indices.reshape(-1, 3)[:, ::-1]).reshape(-1)
    flipped = mesh.tangents * np.array([1, 1, 1, -1], np.float32)
    return replace(mesh, name=f"{mesh.name} (mirrored)", indices=indices, tangents=flipped)


def flattened(mesh: Mesh, linear: FloatArray, tangent_uv_set: int | None) -> Mesh | None:
    """The mesh after a (3, 3) matrix that takes its thickness, its facets' normals anew; None where
    no triangle has an area left."""
    primitive = Primitive(
        positions=(mesh.positions.astype(np.float64) @ linear.T).astype(np.float32),
        indices=mesh.indices,
        uv0=mesh.uv0 if mesh.uv0.any() else None,
        uv1=mesh.uv1 if mesh.uv1.any() else None,
        colors=mesh.colors,
    )
    primitive, _ = drop_degenerate(primitive)
    if not len(primitive.indices):
        return None
    primitive = drop_unused_vertices(primitive)
    return complete(primitive, f"{mesh.name} (flat)", mesh.material, tangent_uv_set)


def _corners(primitive: Primitive) -> npt.NDArray[np.float64]:
    """(3, T, 3) float64 positions of the triangles' corners."""
    triangles = primitive.indices.reshape(-1, 3).T
    corners: npt.NDArray[np.float64] = primitive.positions.astype(np.float64)[triangles]
    return corners


def _take(primitive: Primitive, vertices: npt.NDArray[Any]) -> Primitive:
    arrays = {name: getattr(primitive, name) for name in VERTEX_ARRAYS}
    taken = {name: array[vertices] for name, array in arrays.items() if array is not None}
    if primitive.influences is not None:
        taken["influences"] = primitive.influences.take(vertices)
    if primitive.morphs is not None:
        taken["morphs"] = primitive.morphs.take(vertices)
    return replace(primitive, **taken)


def _with_flat_normals(primitive: Primitive) -> Primitive:
    indices = np.arange(len(primitive.indices), dtype=np.uint32)
    split = replace(_take(primitive, primitive.indices), indices=indices)
    normals = _flat_normals(split)
    if split.morphs is not None:
        # Exact where one target has all the weight: the flat normals of what it makes.
        bent = [replace(split, positions=split.positions + d) for d in split.morphs.positions]
        deltas = np.stack([_flat_normals(shape) - normals for shape in bent])
        split.morphs = replace(split.morphs, normals=deltas)
    # Tangents without normals are to be ignored [glTF 2.0, 3.7.2.1].
    return replace(split, normals=normals, tangents=None)


def _flat_normals(primitive: Primitive) -> FloatArray:
    """(N, 3) float32 of a primitive whose triangles share no vertex; any unit vector where one has
    no area."""
    a, b, c = _corners(primitive)
    normals = _unit(np.cross(b - a, c - a))
    normals[~normals.any(axis=1)] = (0.0, 1.0, 0.0)
    return np.repeat(normals, 3, axis=0).astype(np.float32)


def _repaired_normals(primitive: Primitive, normals: FloatArray) -> FloatArray:
    """Unit normals; area-weighted averages where the file's are zero or not finite."""
    with np.errstate(over="ignore", invalid="ignore"):
        length2 = np.einsum("ij,ij->i", normals, normals, dtype=np.float64)
    broken = ~(np.isfinite(length2) & (length2 > 0.0))
    unit = _unit(np.where(broken[:, None], 0.0, normals))
    if broken.any():
        unit[broken] = _area_weighted_normals(primitive)[broken]
    return unit.astype(np.float32)


def _area_weighted_normals(primitive: Primitive) -> npt.NDArray[np.float64]:
    a, b, c = _corners(primitive)
    weighted = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    count = len(primitive.positions)
    sums = [np.bincount(primitive.indices, weighted[:, k], count) for k in range(3)]
    averaged = _unit(np.stack(sums, axis=1))
    # Where a vertex's triangles cancel out, any direction does.
    averaged[~averaged.any(axis=1)] = (0.0, 1.0, 0.0)
    return averaged


def _repaired_tangents(tangents: FloatArray, normals: FloatArray) -> FloatArray:
    """Unit tangents with w = ±1; zero or non-finite ones replaced."""
    with np.errstate(over="ignore", invalid="ignore"):
        length2 = np.einsum("ij,ij->i", tangents[:, :3], tangents[:, :3], dtype=np.float64)
    usable = np.isfinite(length2) & (length2 > 0.0)
    if not usable.all():
        tangents = np.where(usable[:, None], tangents, any_tangents(normals))
    handedness = np.where(tangents[:, 3:] < 0.0, -1.0, 1.0)
    return np.concatenate([_unit(tangents[:, :3]), handedness], axis=1).astype(np.float32)


def _texture_coordinates(uv: FloatArray | None, count: int) -> FloatArray:
    if uv is None:
        return np.zeros((count, 2), np.float32)
    return uv if np.isfinite(uv).all() else np.nan_to_num(uv, nan=0.0, posinf=0.0, neginf=0.0)


def _unit(vectors: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Each row at length 1; a zero row stays zero."""
    wide = vectors.astype(np.float64)
    length = np.sqrt(np.einsum("ij,ij->i", wide, wide))
    unit: npt.NDArray[np.float64] = wide / np.where(length > 0.0, length, 1.0)[:, None]
    return unit
