"""The octree's pools on the device, addressed by node and brick index."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8
from elemental.gpu.refs import Ref, Sampled
from elemental.gpu.resources import Buffer
from elemental.passes.voxel.grid import Grid

CATEGORY = "octree"
BRICK_TEXELS = (3, 3, 18)
"""3x3x3 texels for each of six directions, stacked in z."""
ATLAS_SIDES_LOG2 = (5, 6, 7)
"""Bricks a row of the atlas, as powers of two, the smallest that fits is taken."""
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

    def nbytes(self) -> int:
        """Bytes of the pools that grow with it, the transient fragment queue not counted."""
        bricks = self.bricks * (_struct_bytes("Brick") + 4 * math.prod(BRICK_TEXELS))
        leaves = self.leaves * 8 * (_struct_bytes("VoxelAttributes") + 8)
        return bricks + leaves + self.interior * 8 * 6 * 8 + self.tiles * 8 * _struct_bytes("Node")


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
        )

    @property
    def overflowed(self) -> bool:
        """Whether anything was dropped."""
        return (self.fragments_dropped + self.tiles_dropped + self.bricks_dropped) > 0


def _struct_bytes(name: str) -> int:
    return int(layouts().struct(name).itemsize)


def atlas_side_log2(bricks: int) -> int:
    """Bricks a row of the smallest atlas that holds so many, as a power of two."""
    layers_max = TEXTURE_3D_MAX // BRICK_TEXELS[2]
    for side in ATLAS_SIDES_LOG2:
        if bricks <= layers_max << (2 * side):
            return side
    raise ValueError(f"{bricks} bricks are more than an atlas can hold")


def atlas_size(bricks: int, side_log2: int) -> tuple[int, int, int]:
    """(width, height, depth) in texels."""
    side = 1 << side_log2
    layers = -(-bricks // (side * side))
    return side * BRICK_TEXELS[0], side * BRICK_TEXELS[1], layers * BRICK_TEXELS[2]


def _empty_state() -> np.ndarray[tuple[int, ...], np.dtype[np.void]]:
    """An OctreeState before the first fragment: its dispatch grows in x alone."""
    state = np.zeros((), layouts().struct("OctreeState"))
    state["fragments"]["y"] = state["fragments"]["z"] = 1
    return state


class Survey:
    """What counting needs of an octree, without its pools: grid, state, regions, uniform block.

    ``max_emission``: the largest radiance that any material emits, which scales the fixed-point
    sums; 0 where nothing emits.
    """

    def __init__(self, device: Device, grid: Grid, capacity: Capacity, max_emission: float) -> None:
        self.device = device
        self.grid = grid
        self.capacity = capacity
        self.max_emission = max_emission
        self.regions = device.buffer(
            "octree.regions", grid.region_levels.ravel(), category=CATEGORY
        )
        self.state = device.buffer("octree.state", _struct_bytes("OctreeState"), category=CATEGORY)
        self.empty_state = device.buffer("octree.empty_state", _empty_state(), category=CATEGORY)
        self.params: dict[str, Block] = {"Octree": self._pack(ATLAS_SIDES_LOG2[0], (1.0, 1.0, 1.0))}

    def _pack(self, atlas_side_log2: int, atlas_texel: tuple[float, ...]) -> Block:
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
            atlas_side_log2=atlas_side_log2,
            fragment_capacity=capacity.fragments,
            tile_capacity=capacity.tiles,
            brick_capacity=capacity.bricks,
            leaf_capacity=capacity.leaves,
            interior_capacity=capacity.interior,
            atlas_texel=atlas_texel,
            ambient=(0.0, 0.0, 0.0),
        )

    def release(self) -> None:
        """Free what it holds on the device."""
        for buffer in (self.regions, self.state, self.empty_state):
            buffer.release()


class Octree(Survey):
    """Nodes, bricks, attributes, radiance, filtered values and the atlas of one grid."""

    def __init__(self, device: Device, grid: Grid, capacity: Capacity, max_emission: float) -> None:
        super().__init__(device, grid, capacity, max_emission)

        def pool(name: str, nbytes: int) -> Buffer:
            return device.buffer(f"octree.{name}", max(nbytes, 16), category=CATEGORY)

        self.nodes = pool("nodes", (grid.dense_nodes + capacity.tiles * 8) * _struct_bytes("Node"))
        self.bricks = pool("bricks", capacity.bricks * _struct_bytes("Brick"))
        attribute_bytes = 8 * _struct_bytes("VoxelAttributes")
        self.attributes = pool("attributes", capacity.leaves * attribute_bytes)
        self.radiance = pool("radiance", capacity.leaves * 8 * 8)
        self.sided = pool("sided", capacity.interior * 8 * 6 * 8)
        side = atlas_side_log2(capacity.bricks)
        size = atlas_size(capacity.bricks, side)
        self.atlas = device.texture("octree.atlas", size, RGBA8, category=CATEGORY)
        self.params = {"Octree": self._pack(side, tuple(1.0 / texels for texels in size))}

    def tracing_reads(self) -> dict[str, Ref]:
        """What lib/cone.glsl binds."""
        return {"Nodes": self.nodes, "u_brick_atlas": Sampled(self.atlas, filter="linear")}

    def voxel_reads(self) -> dict[str, Ref]:
        """What lib/voxel.glsl binds, but for the nodes."""
        return {
            "Bricks": self.bricks,
            "State": self.state,
            "Attributes": self.attributes,
            "Radiance": self.radiance,
        }

    def release(self) -> None:
        """Free every pool."""
        super().release()
        for pool in (self.nodes, self.bricks, self.attributes, self.radiance, self.sided):
            pool.release()
        self.atlas.release()
