"""What an octree keeps from step to step where parts of the scene can move: first the fragments of
what never does. [Mittring12 "Voxel Lighting Pipeline": region keeps static voxel data separate]"""

from __future__ import annotations

from typing import TYPE_CHECKING

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.resources import Buffer
from elemental.gpu.shaders import Compute
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.voxel.build import BLOCK_BYTES, mark, state_offset
from elemental.passes.voxel.octree import (
    CATEGORY,
    NODE_BLOCK_BYTES,
    SIDED_BYTES_A_BRICK,
    Octree,
)
from elemental.passes.voxel.voxelize import append_fragments

if TYPE_CHECKING:
    from elemental.passes.decal_voxels import DecalVoxels

BEGIN = Compute("voxel/begin_step.comp.glsl")
QUEUE_STILL = Compute("voxel/queue.comp.glsl", defines={"STILL": 1})


class Kept:
    """What an octree of a scene with moving parts keeps from step to step, beside its pools.

    Points are a bit each, of all levels: `still` of what never moves, `points` of everything,
    `moving` of what moved into the last step.
    """

    def __init__(self, device: Device, octree: Octree) -> None:
        grid, capacity = octree.grid, octree.capacity
        self._buffers: list[Buffer] = []

        def keep(name: str, nbytes: int) -> Buffer:
            made = device.buffer(f"octree.{name}", max(nbytes, 16), category=CATEGORY)
            self._buffers.append(made)
            return made

        points = grid.point_block_count * BLOCK_BYTES
        self.fragments = keep(
            "fragments", capacity.fragments * layouts().struct("VoxelFragment").itemsize
        )
        self.links = keep("links", capacity.fragments * 4)
        self.heads = keep("heads", capacity.leaves * 8 * 8)
        self.still_points = keep("still_points", points)
        self.still_nodes = keep("still_nodes", grid.block_count * NODE_BLOCK_BYTES)
        self.points = keep("points", points)
        self.moving_points = keep("moving_points", points)
        self.dirty = keep("dirty", points + grid.block_count * BLOCK_BYTES)
        self.old_blocks = keep("old_blocks", octree.node_blocks.nbytes)
        self.kept_sums = keep("kept_sums", grid.node_block_count * 8)
        self.free_slots = keep("free_slots", sum(capacity.slots(grid.one_leaf_level)) * 4)
        self.sided = keep("sided", capacity.interior * SIDED_BYTES_A_BRICK)

    def release(self) -> None:
        """Free all of it."""
        for buffer in self._buffers:
            buffer.release()


def keep_still(
    g: Graph, scene: GpuScene, octree: Octree, kept: Kept, decals: DecalVoxels | None = None
) -> None:
    """Rasterize what never moves, for all steps to come, and forget the steps so far."""
    g.copy_buffer(octree.empty_state, octree.state)
    append_fragments(g, scene, octree, kept.fragments, dynamic=False)
    _mark_still(g, octree, kept, decals)


def _mark_still(g: Graph, octree: Octree, kept: Kept, decals: DecalVoxels | None = None) -> None:
    g.compute(QUEUE_STILL, writes={"State": octree.state}, params=octree.params, groups=1)
    if decals is not None:
        decals.paint(g, octree, kept.fragments, moving=False)
    mark(g, octree, kept.fragments, kept.still_points, kept.still_nodes)
    g.clear_buffer(kept.moving_points)


def carry_still(g: Graph, old: Octree, old_kept: Kept, octree: Octree, kept: Kept) -> None:
    """Take over the fragments of what never moves from an octree on the same lattice."""
    g.copy_buffer(old.state, octree.state)
    g.copy_buffer(old_kept.fragments, kept.fragments)


def mark_still(g: Graph, octree: Octree, kept: Kept) -> None:
    """Find the places of the still fragments anew, and forget the steps so far."""
    state = octree.state
    g.compute(BEGIN, writes={"State": state}, params=octree.params, groups=1)
    stale = state_offset("stale")
    g.copy_buffer(octree.empty_state, state, 4, src_offset=stale, dst_offset=stale)
    _mark_still(g, octree, kept)
