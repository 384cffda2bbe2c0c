"""Where the octree's cube stands in the world, and how its levels are laid out. No GL."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from elemental.core.layout import layouts
from elemental.scene.model import Region

REGION_SIDE = 8
"""Regions along a side of the scene; REGION_SIDE of glsl/shared/octree.glsl."""
REGION_LEVEL = 4
"""The octree level whose nodes are as large as a region: the scene is half the cube."""
MAX_LEVEL = 9
"""Finest leaf level, 512 lattice points along the scene: what a brick's packed cell can say."""
DENSE_LEVELS_BELOW_LEAF = 3
"""Where the dense levels end. The scene's margin keeps finer lattices inside the scene's part."""
MARGIN_VOXELS = 3
"""Empty lattice points between the scene and the sides of its part of the cube."""
MIN_SIZE_M = 1e-6
"""Side of the cube of a scene that is a single point."""


def octal_sum(n: int) -> int:
    """8^0 + ... + 8^(n-1)."""
    return int(8**n - 1) // 7


@dataclass(frozen=True)
class Grid:
    """A cube of lattice points whose middle half holds the scene, in 8^3 regions with leaf levels.

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
        regions: Sequence[Region] = (),
        finest: int = MAX_LEVEL,
    ) -> Grid:
        """The cube for ``bounds`` (min, max), m; ``resolution`` lattice points along the scene.

        Each of ``regions`` shifts the leaf level of the cells of the 8^3 that it overlaps; the
        last one wins. Levels stay within what the octree can hold, and no finer than ``finest``.
        """
        low, high = (np.asarray(corner, np.float64) for corner in bounds)
        resolution = min(resolution, 1 << finest)
        leaf_level = resolution.bit_length() - 1
        extent = max(float((high - low).max()), MIN_SIZE_M)
        spacing = extent / (resolution - 1 - 2 * MARGIN_VOXELS)
        corner = (low + high) * 0.5 - (resolution - 1) * 0.5 * spacing
        levels = np.full((REGION_SIDE,) * 3, leaf_level, np.int64)
        for region in regions:
            cells = _overlapped(region, corner, spacing * resolution / REGION_SIDE)
            levels[cells] = np.clip(leaf_level + region.level_offset, REGION_LEVEL + 1, finest)
        # A leaf answers for finer levels where a descent ends at it: below the dense levels.
        levels = np.maximum(levels, levels.max() - DENSE_LEVELS_BELOW_LEAF)
        # The cube reaches half the scene's side beyond it; its lattice stays the finest region's.
        origin = corner - 0.5 * resolution * spacing
        return cls(origin.astype(np.float32), 2 * resolution * spacing, levels.astype(np.uint32))

    @classmethod
    def ladder(
        cls,
        bounds: tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]],
        resolution: int,
        regions: Sequence[Region] = (),
    ) -> tuple[Grid, ...]:
        """`fit`, and what to fall back to where no pools can hold it: the finest leaf level one
        less each time, down to REGION_LEVEL + 1."""
        first = cls.fit(bounds, resolution, regions)
        coarser = range(first.leaf_level - 1, REGION_LEVEL, -1)
        return first, *(cls.fit(bounds, resolution, regions, finest) for finest in coarser)

    @cached_property
    def leaf_level(self) -> int:
        """The finest leaf level of any region."""
        return int(self.region_levels.max())

    @cached_property
    def coarsest_leaf(self) -> int:
        """The coarsest leaf level of any region."""
        return int(self.region_levels.min())

    @property
    def coarser_leaves(self) -> npt.NDArray[np.uint32]:
        """(8, 4) uint32: two bits a region, x fastest, of how many levels its leaves are above the
        finest: `Octree.coarser_leaves` of glsl/shared/octree.glsl."""
        above = (self.leaf_level - self.region_levels).reshape(8, 4, 16)
        shifts = 2 * np.arange(16, dtype=np.uint32)
        words: npt.NDArray[np.uint32] = np.bitwise_or.reduce(above.astype(np.uint32) << shifts, 2)
        return words

    @property
    def one_leaf_level(self) -> bool:
        """Whether all regions have the finest."""
        return self.coarsest_leaf == self.leaf_level

    @property
    def top_level(self) -> int:
        """Levels up to here are dense and cover the whole cube, deeper ones the scene alone."""
        return self.leaf_level - DENSE_LEVELS_BELOW_LEAF

    @property
    def resolution(self) -> int:
        """Lattice points along a side of the scene, half the cube's, at the finest level."""
        return 1 << self.leaf_level

    @property
    def voxel_m(self) -> float:
        """Metres between points of the finest lattice."""
        return self.size / (2 * self.resolution)

    def first_block(self, exponent: int) -> int:
        """First 64-cell block of the grid with 2^exponent cells a side (lib/node_bits.glsl)."""
        return sum(self.grid_blocks(k) for k in range(exponent))

    def grid_blocks(self, exponent: int) -> int:
        """64-cell blocks of that grid: all cells, or from top_level + 2 on the scene's."""
        side_log2 = exponent if exponent <= self.top_level + 1 else exponent - 1
        return 1 if side_log2 < 2 else 8 ** (side_log2 - 2)

    @cached_property
    def block_count(self) -> int:
        """64-node blocks of all levels together."""
        return self.first_block(self.leaf_level + 1)

    @property
    def scan_groups(self) -> int:
        """Groups of blocks whose sums the prefix sums keep."""
        return -(-self.block_count // int(layouts().constant("SCAN_BLOCKS")))

    @property
    def node_block_count(self) -> int:
        """64-node blocks, and one more for each group of them (lib/node_blocks.glsl)."""
        return self.block_count + self.scan_groups

    @cached_property
    def point_block_count(self) -> int:
        """64-point blocks of the lattices of all levels together."""
        return self.first_block(self.leaf_level + 2)

    @property
    def dense_nodes(self) -> int:
        """Nodes of the dense levels."""
        return octal_sum(self.top_level + 1)


def _overlapped(
    region: Region, corner: npt.NDArray[np.float64], cell_m: float
) -> tuple[slice, slice, slice]:
    """The cells of the 8^3 regions, as a [z, y, x] index, that a world-space box overlaps."""
    first = np.floor((region.minimum - corner) / cell_m).clip(0, REGION_SIDE).astype(int)
    end = np.ceil((region.maximum - corner) / cell_m).clip(0, REGION_SIDE).astype(int)
    x, y, z = (slice(int(a), int(b)) for a, b in zip(first, end, strict=True))
    return z, y, x
