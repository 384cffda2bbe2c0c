"""The octree's pools on the device, addressed by node and brick index."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8, RGBA8_SNORM, Format
from elemental.gpu.refs import Ref, Sampled
from elemental.gpu.resources import Buffer, Texture
from elemental.passes.voxel.grid import Grid

CATEGORY = "octree"
SIDED_TEXELS = (3, 3, 21)
"""A brick above the finest level: 3x3x3 texels for each of six directions and for the opacities
along the axes, stacked in z."""
LEAF_TEXELS = (3, 3, 3)
"""A brick of the finest level, in the atlas of colours and in that of normals."""
SIDED_BYTES_A_BRICK = 8 * 7 * 8
"""Half floats of its 2x2x2 voxels: six sides, opacities (shared/sided.glsl)."""
RADIANCE_BYTES = 4
"""Of a leaf voxel: RGB9E5."""
ATLAS_SIDES_LOG2 = (5, 6, 7)
"""Bricks a row of the atlas, as powers of two, the smallest that fits is taken."""
NODE_BLOCK_BYTES = 16
"""64 bits, bricks and tiles before them: lib/node_blocks.glsl."""
TEXTURE_3D_MAX = 2048
"""The smallest GL_MAX_3D_TEXTURE_SIZE that OpenGL 4.3 allows."""
ACCUMULATOR_MAX = 65535.0
"""Largest fixed-point value one fragment adds: 65,536 fragments a voxel fit in 32 bits."""


@dataclass(frozen=True)
class Capacity:
    """How many of each the pools hold."""

    fragments: int
    tiles: int
    bricks: int
    leaves: int
    interior: int

    def slots(self, one_leaf_level: bool) -> tuple[int, int, int, int]:
        """How many slots there are for bricks above the leaves, other bricks above the finest
        level, the finest bricks, and tiles (SlotPool)."""
        coarse = self.bricks if one_leaf_level else self.bricks - self.leaves
        coarse = min(self.interior, max(coarse, 0))
        mixed = 0 if one_leaf_level else min(self.interior - coarse, self.leaves)
        finest = max(min(self.bricks - coarse - mixed, self.leaves - mixed), 0)
        return coarse, mixed, finest, self.tiles

    def nbytes(self, keeps_slots: bool = False) -> int:
        """Bytes at most of the pools that grow with it, without the transient fragment queue.

        ``keeps_slots``: with the queue and all else that is kept where things move.
        """
        sided = self.interior * 4 * (math.prod(SIDED_TEXELS) + 8)
        finest = (self.bricks - self.interior) * 2 * 4 * math.prod(LEAF_TEXELS)
        leaves = self.leaves * 8 * (_struct_bytes("VoxelAttributes") + RADIANCE_BYTES + 4)
        nodes = self.tiles * 8 * _struct_bytes("Node") + self.bricks * _struct_bytes("Brick")
        kept = 0
        if keeps_slots:
            queue = self.fragments * (_struct_bytes("VoxelFragment") + 4)
            tables = 4 * 4 * (self.bricks + self.tiles)  # now, before, free, listed
            kept = queue + self.leaves * 8 * 8 + self.interior * SIDED_BYTES_A_BRICK + tables
        return sided + finest + leaves + nodes + kept


@dataclass(frozen=True)
class Counts:
    """What a build asked for and what it kept, as the GPU counted."""

    fragments: int
    fragments_dropped: int
    tiles: int
    tiles_dropped: int
    bricks: int
    bricks_dropped: int
    leaves: int
    interior: int
    leaves_asked: int
    interior_asked: int

    @classmethod
    def from_state(cls, raw: bytes) -> Counts:
        """From the bytes of an OctreeState."""
        state = np.frombuffer(raw, layouts().struct("OctreeState"), count=1)[0]
        return cls(
            fragments=int(state["fragment_count"]) - int(state["fragment_dropped"]),
            fragments_dropped=int(state["fragment_dropped"]),
            tiles=int(state["tile_count"]),
            tiles_dropped=int(state["tile_dropped"]),
            bricks=int(state["brick_count"]),
            bricks_dropped=int(state["brick_dropped"]),
            leaves=int(state["leaf_count"]),
            interior=int(state["interior_count"]),
            leaves_asked=int(state["leaf_asked"]),
            interior_asked=int(state["interior_asked"]),
        )

    @property
    def overflowed(self) -> bool:
        """Whether anything was dropped."""
        return (self.fragments_dropped + self.tiles_dropped + self.bricks_dropped) > 0


def _struct_bytes(name: str) -> int:
    return int(layouts().struct(name).itemsize)


@dataclass(frozen=True)
class Atlas:
    """How bricks stand in a 3D texture: 2^side_log2 a row, as many rows a layer."""

    side_log2: int
    size: tuple[int, int, int]
    """(width, height, depth) in texels."""

    @classmethod
    def fit(cls, bricks: int, brick_texels: tuple[int, int, int]) -> Atlas:
        """The smallest that holds so many bricks. Raises ValueError where none can."""
        for side_log2 in ATLAS_SIDES_LOG2:
            side = 1 << side_log2
            layers = -(-max(bricks, 1) // (side * side))
            width, height, depth = brick_texels
            if layers * depth <= TEXTURE_3D_MAX:
                return cls(side_log2, (side * width, side * height, layers * depth))
        raise ValueError(f"{bricks} bricks are more than an atlas can hold")

    @staticmethod
    def most(brick_texels: tuple[int, int, int]) -> int:
        """How many bricks the largest holds."""
        return TEXTURE_3D_MAX // brick_texels[2] << 2 * ATLAS_SIDES_LOG2[-1]

    @property
    def texel(self) -> tuple[float, float, float]:
        """A texel's share of the texture along each axis."""
        width, height, depth = self.size
        return 1.0 / width, 1.0 / height, 1.0 / depth


def _empty_state() -> np.ndarray[tuple[int, ...], np.dtype[np.void]]:
    """An OctreeState before the first fragment: its dispatch grows in x alone."""
    state = np.zeros((), layouts().struct("OctreeState"))
    state["fragments"]["y"] = state["fragments"]["z"] = 1
    state["stale"] = 1
    return state


class Survey:
    """What counting needs of an octree, without its pools: grid, state, regions, uniform block.

    ``max_emission``: the largest radiance that any material emits, which scales the fixed-point
    sums; 0 where nothing emits. ``keeps_slots``: bricks and tiles outlive a build in their slots.
    """

    def __init__(
        self,
        device: Device,
        grid: Grid,
        capacity: Capacity,
        max_emission: float,
        keeps_slots: bool = False,
    ) -> None:
        self.device = device
        self.grid = grid
        self.capacity = capacity
        self.max_emission = max_emission
        self.keeps_slots = keeps_slots
        self.regions = device.buffer(
            "octree.regions", grid.region_levels.ravel(), category=CATEGORY
        )
        self.state = device.buffer("octree.state", _struct_bytes("OctreeState"), category=CATEGORY)
        self.empty_state = device.buffer("octree.empty_state", _empty_state(), category=CATEGORY)
        slots = capacity.bricks + capacity.tiles if keeps_slots else 0
        self.node_blocks = device.buffer(
            "octree.node_blocks",
            grid.node_block_count * NODE_BLOCK_BYTES + slots * 4,
            category=CATEGORY,
        )
        none = Atlas.fit(1, LEAF_TEXELS)
        self.params: dict[str, Block] = {"Octree": self._pack(none, none)}

    def _pack(self, sided: Atlas, leaf: Atlas) -> Block:
        grid, capacity = self.grid, self.capacity
        fixed_point = ACCUMULATOR_MAX / self.max_emission if self.max_emission > 0.0 else 0.0
        return pack(
            layouts().block("Octree"),
            origin_size=(*grid.origin, grid.size),
            leaf_level=grid.leaf_level,
            top_level=grid.top_level,
            coarsest_leaf=grid.coarsest_leaf,
            resolution=grid.resolution,
            voxel_m=grid.voxel_m,
            fixed_point=fixed_point,
            block_count=grid.block_count,
            atlas_side_log2=sided.side_log2,
            leaf_atlas_side_log2=leaf.side_log2,
            fragment_capacity=capacity.fragments,
            tile_capacity=capacity.tiles,
            brick_capacity=capacity.bricks,
            leaf_capacity=capacity.leaves,
            interior_capacity=capacity.interior,
            keeps_slots=self.keeps_slots,
            brick_list=self._listed_voxels() if self.keeps_slots else 0,
            slot_capacity=capacity.slots(grid.one_leaf_level) if self.keeps_slots else (0,) * 4,
            atlas_texel=sided.texel,
            leaf_atlas_texel=leaf.texel,
            coarser_leaves=grid.coarser_leaves,
        )

    def _listed_voxels(self) -> int:
        """How many voxels can be occupied: leaves of coarser regions by finer neighbours, too."""
        leaves = self.capacity.leaves * 8
        lit = min(leaves, self.capacity.fragments) if self.grid.one_leaf_level else leaves
        return self.capacity.interior * 8 + lit

    def release(self) -> None:
        """Free what it holds on the device."""
        for buffer in (self.regions, self.state, self.empty_state, self.node_blocks):
            buffer.release()


class Octree(Survey):
    """Nodes, bricks, attributes, radiance, filtered values and the atlas of one grid."""

    def __init__(
        self,
        device: Device,
        grid: Grid,
        capacity: Capacity,
        max_emission: float,
        keeps_slots: bool = False,
    ) -> None:
        super().__init__(device, grid, capacity, max_emission, keeps_slots)

        def pool(name: str, nbytes: int) -> Buffer:
            return device.buffer(f"octree.{name}", max(nbytes, 16), category=CATEGORY)

        self.nodes = pool("nodes", (grid.dense_nodes + capacity.tiles * 8) * _struct_bytes("Node"))
        self.bricks = pool("bricks", capacity.bricks * _struct_bytes("Brick"))
        listed_bricks = max(capacity.bricks, capacity.interior) if keeps_slots else 0
        self.voxel_list = pool("voxel_list", (self._listed_voxels() + listed_bricks) * 4)
        attribute_bytes = 8 * _struct_bytes("VoxelAttributes")
        self.attributes = pool("attributes", capacity.leaves * attribute_bytes)
        self.radiance = pool("radiance", capacity.leaves * 8 * RADIANCE_BYTES)
        sided = Atlas.fit(capacity.interior, SIDED_TEXELS)
        leaf = Atlas.fit(capacity.bricks - capacity.interior, LEAF_TEXELS)

        def atlas(name: str, place: Atlas, format: Format) -> Texture:
            return device.texture(f"octree.{name}", place.size, format, category=CATEGORY)

        self.atlas = atlas("atlas", sided, RGBA8)
        self.leaf_colors = atlas("leaf_colors", leaf, RGBA8)
        self.leaf_normals = atlas("leaf_normals", leaf, RGBA8_SNORM)
        self.params = {"Octree": self._pack(sided, leaf)}

    def tracing_reads(self) -> dict[str, Ref]:
        """What lib/cone.glsl binds."""
        return {
            "Nodes": self.nodes,
            "u_brick_atlas": Sampled(self.atlas, filter="linear"),
            "u_leaf_colors": Sampled(self.leaf_colors, filter="linear"),
            "u_leaf_normals": Sampled(self.leaf_normals, filter="linear"),
        }

    def voxel_reads(self) -> dict[str, Ref]:
        """What lib/voxel.glsl binds."""
        return {
            "Bricks": self.bricks,
            "State": self.state,
            "Attributes": self.attributes,
            "Radiance": self.radiance,
        }

    def release(self) -> None:
        """Free every pool."""
        super().release()
        for pool in (self.nodes, self.bricks, self.voxel_list, self.attributes, self.radiance):
            pool.release()
        for atlas in (self.atlas, self.leaf_colors, self.leaf_normals):
            atlas.release()
