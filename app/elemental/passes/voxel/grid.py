"""Where the octree's cube stands in the world, and how its levels are laid out. No GL."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

REGION_SIDE = 8
"""Regions a side of the cube; REGION_SIDE of glsl/shared/octree.glsl."""
REGION_LEVEL = 3
"""The octree level whose nodes are the regions: log2(REGION_SIDE)."""
MAX_LEVEL = 9
"""Finest leaf level: 1,024 lattice points a side, ten bits of a fragment's position."""
DENSE_TOP_LEVEL = 5
"""Levels up to this one are dense arrays, which saves that many hops of every descent."""
MARGIN_VOXELS = 3
"""Empty lattice points kept between the scene and the cube's sides."""
MIN_SIZE_M = 1e-6
"""Side of the cube of a scene that is a single point."""


def grid_first_block(exponent: int) -> int:
    """First 64-cell block of the grid with 2^exponent cells a side (lib/node_bits.glsl)."""
    return exponent if exponent < 2 else 2 + (8 ** (exponent - 2) - 1) // 7


def grid_block_count(exponent: int) -> int:
    """64-cell blocks of the grid with 2^exponent cells a side."""
    return 1 if exponent < 2 else 8 ** (exponent - 2)


def dense_node_count(top_level: int) -> int:
    """Nodes of the levels 0..top_level when all exist."""
    return (8 ** (top_level + 1) - 1) // 7


@dataclass(frozen=True)
class Grid:
    """A cube of lattice points with a leaf level for each of its 8^3 regions.

    origin (3,) float32, m: the position of lattice point 0; size, m: the cube's side;
    region_levels (8, 8, 8) uint32 by [z, y, x]: the leaf level of each region.
    """

    origin: npt.NDArray[np.float32]
    size: float
    region_levels: npt.NDArray[np.uint32] = field(repr=False)

    @classmethod
    def fit(
        cls,
        bounds: tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]],
        resolution: int,
        region_offsets: npt.NDArray[np.int64] | None = None,
    ) -> Grid:
        """The cube around ``bounds`` (min, max), m, with ``resolution`` lattice points a side.

        ``region_offsets`` (8, 8, 8) by [z, y, x]: levels finer (+) or coarser (-) than that.
        """
        low, high = (np.asarray(corner, np.float64) for corner in bounds)
        leaf_level = resolution.bit_length() - 2
        extent = max(float((high - low).max()), MIN_SIZE_M)
        spacing = extent / (resolution - 1 - 2 * MARGIN_VOXELS)
        size = spacing * resolution
        origin = (low + high) * 0.5 - (resolution - 1) * 0.5 * spacing
        levels = np.full((REGION_SIDE,) * 3, leaf_level, np.int64)
        if region_offsets is not None:
            levels = np.clip(levels + region_offsets, REGION_LEVEL, MAX_LEVEL)
        return cls(origin.astype(np.float32), size, levels.astype(np.uint32))

    @property
    def leaf_level(self) -> int:
        """The finest leaf level of any region."""
        return int(self.region_levels.max())

    @property
    def coarsest_leaf(self) -> int:
        """The coarsest leaf level of any region."""
        return int(self.region_levels.min())

    @property
    def top_level(self) -> int:
        """Levels up to here are dense; two levels at least are sparse."""
        return min(DENSE_TOP_LEVEL, self.leaf_level - 2)

    @property
    def resolution(self) -> int:
        """Lattice points a side at the finest level."""
        return 2 << self.leaf_level

    @property
    def voxel_m(self) -> float:
        """Metres between points of the finest lattice."""
        return self.size / self.resolution

    @property
    def block_count(self) -> int:
        """64-node blocks of all levels together."""
        return grid_first_block(self.leaf_level + 1)

    @property
    def point_block_count(self) -> int:
        """64-point blocks of the lattices of all levels together."""
        return grid_first_block(self.leaf_level + 2)
