"""Finds the diffuse cones' directions: prints the tables of glsl/lib/cone_directions.glsl.

For each count the points of least Coulomb energy on the sphere (J. J. Thomson, 1904), turned so
that the weights c (1 + s c), c = n . d where above LEAST_COSINE, normalized, give with a small
error the cosine-weighted mean of environments of spherical harmonics order 2 over all normals n,
and of a white sky beside walls that stand along the axes. Of the best turns one is picked, the
nearest to the path tracer in tests/accuracy. Splits of nine are assigned to the nine so that each
group's cones lie together.

    python tools/cone_directions.py            # print the tables and their errors
"""

from __future__ import annotations

from itertools import permutations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

GROUPS = 9
SPLITS = {1: 0.6, 4: 0.12, 7: 0.02}
"""Cones a group -> slope s of the weight, of the smallest error."""
LEAST_COSINE = 0.1
"""Of glsl/lib/cone_directions.glsl."""
DESCENT_STEPS = 4000
ROTATIONS = 4000
PICKED = {1: 1, 4: 8, 7: 0}
"""Cones a group -> rank of the turn by its error."""
NORMALS = 300
AXIS_SHARE = 20
"""How often each of the six axis directions counts among the normals: floors and walls."""
KERNEL_SHARE = 0.8
"""Of a cone's half angle: the disc that stands for its footprint."""
HIDES = ([0, 0.1, 0.3, 0.5, 0.7, 1], [0, 0.06, 0.4, 0.93, 1, 1])
"""What a wall of two voxels or more beside a cone covers of it -> what it then hides, measured."""
BAND = np.array([0, 1, 1, 1, 2, 2, 2, 2, 2])
COSINE_MEAN = np.array([1, 2 / 3, 1 / 4])[BAND]
"""Zonal factors of the cosine lobe over pi [Ramamoorthi01]."""


def sphere_points(count: int) -> Array:
    """(count, 3) points of a low Coulomb energy, by gradient descent from random ones."""
    rng = np.random.default_rng(2)
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


def gather_error(directions: Array, slope: float, normals: Array) -> tuple[float, float]:
    """(rms, largest) error over the normals, relative to the harmonics' own scale."""
    cosine = np.cos(half_angle(len(directions)) * KERNEL_SHARE)
    kernel = np.array([1, (1 + cosine) / 2, cosine * (1 + cosine) / 2])[BAND]
    cosines = normals @ directions.T
    weights = np.where(cosines > LEAST_COSINE, cosines * (1.0 + slope * cosines), 0.0)
    weights /= weights.sum(axis=1, keepdims=True)
    missed = weights @ (harmonics(directions) * kernel) - harmonics(normals) * COSINE_MEAN
    squared = (missed**2).sum(axis=1)
    return float(np.sqrt(squared.mean())), float(np.sqrt(squared.max()))


def half_angle(count: int) -> float:
    """Half angle, radians, of the cone whose solid angle is the sphere's over ``count``."""
    return float(np.arccos(1 - 2 / count))


def wall_error(directions: Array, slope: float) -> float:
    """Rms error of what is seen of a white sky beside endless walls of all sides and heights."""
    elevation = np.radians(np.arange(5, 90, 5))[:, None]
    errors = []
    for normal, side in permutations([*np.eye(3), *-np.eye(3)], 2):
        if normal @ side:
            continue
        cosines = directions @ normal
        weights = np.where(cosines > LEAST_COSINE, cosines * (1.0 + slope * cosines), 0.0)
        edge = normal * np.cos(elevation) - side * np.sin(elevation)
        u = np.arcsin(np.clip(edge @ directions.T, -1, 1)) / half_angle(len(directions))
        u = np.clip(u, -1, 1)
        covered = 0.5 - (np.arcsin(u) + u * np.sqrt(1 - u * u)) / np.pi
        seen = (1 - np.interp(covered, *HIDES)) @ weights / weights.sum()
        errors.append(seen - (1 + np.cos(elevation[:, 0])) / 2)
    return float(np.sqrt(np.square(errors).mean()))


def best_rotation(points: Array, slope: float, rank: int) -> Array:
    """The points turned for the smallest error but ``rank`` ones."""
    rng = np.random.default_rng(1)
    normals = np.concatenate([_fibonacci(NORMALS), np.repeat(np.eye(3), AXIS_SHARE, axis=0)])
    normals = np.concatenate([normals, -np.repeat(np.eye(3), AXIS_SHARE, axis=0)])

    def cost(turned: Array) -> float:
        return wall_error(turned, slope) + 0.5 * gather_error(turned, slope, normals)[0]

    turned = [points @ np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in range(ROTATIONS)]
    found: Array = sorted(turned, key=cost)[rank]
    return found


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
    leaders = best_rotation(sphere_points(GROUPS), SPLITS[1], PICKED[1])
    for split, slope in SPLITS.items():
        count = GROUPS * split
        found = leaders
        if split > 1:
            found = best_rotation(sphere_points(count), slope, PICKED[split])
        directions = grouped(found, leaders)
        rms, largest = gather_error(directions, slope, _fibonacci(NORMALS))
        print(f"//   {count:5}  {slope:.2f}  {rms:.1%}  {largest:.1%}")
        print(f"const float CONE_WEIGHT_SLOPE = {slope:.2f};")
        print(f"const float CONE_HALF_ANGLE = {half_angle(count):.4f};")
        rows = ",\n".join(f"    vec3({x:.4f}, {y:.4f}, {z:.4f})" for x, y, z in directions)
        print(f"const vec3 CONE_DIRECTIONS[{count}] = vec3[{count}](\n{rows});")


if __name__ == "__main__":
    main()
