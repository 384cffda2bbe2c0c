"""Which nodes an octree has, worked out from its fragments alone, densely, in NumPy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.passes.voxel.grid import REGION_LEVEL, REGION_SIDE, Grid

Array = npt.NDArray[Any]


def leaf_level_of(grid: Grid, cells: Array, level: int) -> Array:
    """(N,) leaf level of the regions of cells (N, 3) of ``level``; else, the nearest region's."""
    up = level - REGION_LEVEL
    regions = np.asarray(cells) >> up if up >= 0 else np.asarray(cells) << -up
    x, y, z = np.clip(regions - REGION_SIDE // 2, 0, REGION_SIDE - 1).T
    return np.asarray(grid.region_levels[z, y, x], np.int64)


def leaf_points(grid: Grid, points: Array) -> tuple[Array, Array]:
    """(N,) leaf levels, (N, 3) points of the cube's lattice of that level, of fragments.

    ``points`` (N, 3): on the finest lattice, from the scene's corner. A coarser region takes the
    nearest of its own points.
    """
    region_points = grid.resolution // REGION_SIDE
    x, y, z = (points // region_points).T
    levels = grid.region_levels[z, y, x].astype(np.int64)
    shift = (grid.leaf_level - levels)[:, None]
    last = ((points // region_points + 1) * region_points - 1) >> shift
    nearest = np.minimum((points + (1 << shift) // 2) >> shift, last)
    return levels, nearest + ((grid.resolution // 2) >> shift)


@dataclass
class DenseOctree:
    """Nodes ``exists[level]`` (2^level,)*3 bool, points ``occupied[level]`` (2^(level+1),)*3 bool.

    By [x, y, z].
    """

    exists: list[Array]
    occupied: list[Array]

    @classmethod
    def of(cls, grid: Grid, fragment_points: Array) -> DenseOctree:
        """A node exists iff one of the 3x3x3 lattice points that it touches is occupied; a point
        of a coarser lattice is occupied iff one is within 1 of twice it on the next finer."""
        levels, points = leaf_points(grid, fragment_points)
        exists: list[Array] = []
        occupied: list[Array] = []
        for level in range(grid.leaf_level, -1, -1):
            here = np.zeros((2 << level,) * 3, bool)
            if occupied:
                here |= reduced(occupied[-1], -1)
            here[tuple(points[levels == level].T)] = True
            touched = reduced(here, 0)
            if level > REGION_LEVEL:
                cells = np.argwhere(touched)
                touched[tuple(cells[leaf_level_of(grid, cells, level) < level].T)] = False
            exists.append(touched)
            occupied.append(here)
        return cls(exists[::-1], occupied[::-1])


def reduced(points: Array, first: int) -> Array:
    """Whether any of the points 2n + first .. 2n + first + 2 is set, along each axis."""
    for axis in range(3):
        lines = np.moveaxis(points, axis, 0)
        padded = np.concatenate([np.zeros_like(lines[:1]), lines, np.zeros_like(lines[:1])])
        start, count = first + 1, len(lines) // 2
        reach = [padded[start + k : start + k + 2 * count : 2][:count] for k in range(3)]
        points = np.moveaxis(reach[0] | reach[1] | reach[2], 0, axis)
    return points
