"""Finds the diffuse cones' directions: prints the tables of glsl/lib/cone_directions.glsl.

For each count the points of least Coulomb energy on the sphere (J. J. Thomson, 1904), turned so
that the weights max(0, n . d)^p, normalized, give the cosine-weighted mean of environments of
spherical harmonics order 2 with the smallest error over all normals n. Splits of nine are assigned
to the nine so that each group's cones lie together.

    python tools/cone_directions.py            # print the tables and their errors
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

GROUPS = 9
SPLITS = {1: 1.3, 4: 1.1, 7: 1.0}
"""Cones a group -> exponent of the weight."""
DESCENT_STEPS = 4000
ROTATIONS = 400
NORMALS = 600
AXIS_SHARE = 40
"""How often each of the six axis directions counts among the normals: floors and walls."""
KERNEL_SHARE = 0.8
"""Of a cone's half angle: the disc that stands for its footprint."""
BAND = np.array([0, 1, 1, 1, 2, 2, 2, 2, 2])
COSINE_MEAN = np.array([1, 2 / 3, 1 / 4])[BAND]
"""Zonal factors of the cosine lobe over pi [Ramamoorthi01]."""


def sphere_points(count: int, rng: np.random.Generator) -> Array:
    """(count, 3) points of a low Coulomb energy, by gradient descent from random ones."""
    points = _unit(rng.normal(size=(count, 3)))
    step = 0.2 / count
    for _ in range(DESCENT_STEPS):
        offsets = points[:, None] - points
        distances = np.linalg.norm(offsets, axis=2) + np.eye(count)
        points = _unit(points + step * (offsets / distances[..., None] ** 3).sum(axis=1))
    return points


def harmonics(d: Array) -> Array:
    """(N, 9) real spherical harmonics of order 2 in the directions (N, 3)."""
    x, y, z = d.T
    columns = [0.282095 + 0 * x, 0.488603 * y, 0.488603 * z, 0.488603 * x, 1.092548 * x * y]
    columns += [1.092548 * y * z, 0.315392 * (3 * z * z - 1), 1.092548 * x * z]
    return np.stack([*columns, 0.546274 * (x * x - y * y)], axis=1)


def gather_error(directions: Array, power: float, normals: Array) -> tuple[float, float]:
    """(rms, largest) error over the normals, relative to the harmonics' own scale."""
    cosine = np.cos(half_angle(len(directions)) * KERNEL_SHARE)
    kernel = np.array([1, (1 + cosine) / 2, cosine * (1 + cosine) / 2])[BAND]
    weights = np.maximum(normals @ directions.T, 0.0) ** power
    weights /= weights.sum(axis=1, keepdims=True)
    missed = weights @ (harmonics(directions) * kernel) - harmonics(normals) * COSINE_MEAN
    squared = (missed**2).sum(axis=1)
    return float(np.sqrt(squared.mean())), float(np.sqrt(squared.max()))


def half_angle(count: int) -> float:
    """Half angle, radians, of the cone whose solid angle is the sphere's over ``count``."""
    return float(np.arccos(1 - 2 / count))


def best_rotation(points: Array, power: float, rng: np.random.Generator) -> Array:
    """The points turned for the smallest error, rms and a share of the largest."""
    normals = np.concatenate([_fibonacci(NORMALS), np.repeat(np.eye(3), AXIS_SHARE, axis=0)])
    normals = np.concatenate([normals, -np.repeat(np.eye(3), AXIS_SHARE, axis=0)])

    def cost(turned: Array) -> float:
        rms, largest = gather_error(turned, power, normals)
        return rms + 0.3 * largest

    turns = (np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in range(ROTATIONS))
    return min((points @ turn for turn in turns), key=cost)


def grouped(directions: Array, leaders: Array) -> Array:
    """The directions in the order of the leaders that they are dealt to, nearest pair first."""
    room = len(directions) // len(leaders)
    near = np.argsort(-(directions @ leaders.T), axis=None)
    groups: list[list[int]] = [[] for _ in leaders]
    dealt: set[int] = set()
    for pair in near:
        one, leader = divmod(int(pair), len(leaders))
        if one not in dealt and len(groups[leader]) < room:
            groups[leader].append(one)
            dealt.add(one)
    return directions[[one for group in groups for one in group]]


def _fibonacci(count: int) -> Array:
    i = np.arange(count) + 0.5
    polar, turn = np.arccos(1 - 2 * i / count), np.pi * (1 + 5**0.5) * i
    sine = np.sin(polar)
    return np.stack([np.cos(turn) * sine, np.sin(turn) * sine, np.cos(polar)], axis=1)


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v, axis=1, keepdims=True))


def main() -> None:
    """Print a GLSL table for each split, headed by its errors."""
    rng = np.random.default_rng(1)
    leaders = best_rotation(sphere_points(GROUPS, rng), SPLITS[1], rng)
    for split, power in SPLITS.items():
        count = GROUPS * split
        found = leaders if split == 1 else best_rotation(sphere_points(count, rng), power, rng)
        directions = grouped(found, leaders)
        rms, largest = gather_error(directions, power, _fibonacci(NORMALS))
        print(f"//   {count:5}  {power:.1f}  {rms:.1%}  {largest:.1%}")
        print(f"const float CONE_WEIGHT_POWER = {power:.1f};")
        print(f"const float CONE_HALF_ANGLE = {half_angle(count):.4f};")
        rows = ",\n".join(f"    vec3({x:.4f}, {y:.4f}, {z:.4f})" for x, y, z in directions)
        print(f"const vec3 CONE_DIRECTIONS[{count}] = vec3[{count}](\n{rows});")


if __name__ == "__main__":
    main()
