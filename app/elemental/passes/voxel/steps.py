"""An octree that follows moving things: only what they touch is built anew. [Mittring12 "Voxel
Lighting Pipeline": optimized for few dynamic objects, region keeps static voxel data separate]

Static geometry is rasterized once and its fragments stay. A step rasterizes what can move, sets the
bits of its points among the static ones, and gives out slots; bricks and tiles that were there keep
theirs. What the moving points left or reached, and what their shadows did, is dirty.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from elemental.core.layout import layouts, pack
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref
from elemental.gpu.shaders import Compute
from elemental.passes.instance_table import Box
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.shadow import ShadowMaps
from elemental.passes.voxel.build import level_params, state_offset
from elemental.passes.voxel.kept import BEGIN, Kept
from elemental.passes.voxel.octree import Octree
from elemental.passes.voxel.voxelize import append_fragments

if TYPE_CHECKING:
    from elemental.passes.decal_voxels import DecalVoxels

BEGIN_LISTS = Compute("voxel/begin_step.comp.glsl", defines={"LISTS_ONLY": 1})
QUEUE = Compute("voxel/queue.comp.glsl")
MARK_MOVING = Compute("voxel/mark.comp.glsl", defines={"MOVING": 1})
RELIGHT = Compute("voxel/relight.comp.glsl")
REDUCE_DIRTY = Compute("voxel/reduce.comp.glsl", defines={"DIRTY": 1})
SCAN_BLOCKS = Compute("voxel/scan_blocks.comp.glsl", defines={"KEEPS_SLOTS": 1})
SCAN_GROUPS = Compute("voxel/scan_groups.comp.glsl", defines={"KEEPS_SLOTS": 1})
SLOT_POOLS = Compute("voxel/slot_pools.comp.glsl")
KEEP_SLOTS = Compute("voxel/keep_slots.comp.glsl")
TAKE_SLOTS = Compute("voxel/take_slots.comp.glsl")
NODES = Compute("voxel/nodes.comp.glsl", defines={"LISTS_DIRTY": 1})
LISTS = Compute("voxel/lists.comp.glsl", defines={"LISTS_DIRTY": 1})
UNLINK = Compute("voxel/unlink.comp.glsl")
LINK_STILL = Compute("voxel/link.comp.glsl", defines={"KEPT_FRAGMENTS": 1})
LINK_MOVING = Compute("voxel/link.comp.glsl", defines={"KEPT_FRAGMENTS": 2})
RESOLVE = Compute("voxel/resolve.comp.glsl", defines={"KEPT_FRAGMENTS": 1})

NO_BLOCKS = range(0)


def step(
    g: Graph,
    scene: GpuScene,
    octree: Octree,
    kept: Kept,
    shadows: ShadowMaps,
    casters: Sequence[Box],
    everything: bool,
    blocks: range = NO_BLOCKS,
    decals: DecalVoxels | None = None,
) -> None:
    """Bring nodes, bricks and leaf attributes up to what moved, and list what is dirty.

    ``casters``: boxes in which something changed its shadow. ``everything``: list all that there
    is, whatever is dirty; ``blocks``: or, beside what is dirty, the leaf voxels of these blocks.
    """
    state = {"State": octree.state}
    g.compute(BEGIN, writes=state, params=octree.params, groups=1)
    append_fragments(g, scene, octree, kept.fragments, dynamic=True)
    g.compute(QUEUE, "voxelize.queue", writes=state, params=octree.params, groups=1)
    if decals is not None:
        decals.paint(g, octree, kept.fragments, moving=True)
    _rebuild_bits(g, octree, kept)
    if not everything:
        _relight(g, octree, kept, shadows, casters, blocks)
    _spread_dirty(g, octree, kept)
    _give_slots(g, octree, kept)
    list_dirty(g, octree, kept, everything)
    _resolve(g, octree, kept)


def refresh(g: Graph, octree: Octree, kept: Kept, shadows: ShadowMaps, blocks: range) -> None:
    """List the leaf voxels of some blocks, and what depends on them."""
    g.compute(BEGIN_LISTS, writes={"State": octree.state}, params=octree.params, groups=1)
    g.clear_buffer(kept.dirty)
    _relight(g, octree, kept, shadows, (), blocks)
    _spread_dirty(g, octree, kept)
    list_dirty(g, octree, kept, everything=False)


def _rebuild_bits(g: Graph, octree: Octree, kept: Kept) -> None:
    """The leaf points that there are now, and as dirty those that moving fragments left or reached.

    The bits of coarser points and of nodes begin as those of what stands.
    """
    g.clear_buffer(kept.dirty)
    g.copy_buffer(kept.moving_points, kept.dirty)
    g.clear_buffer(kept.moving_points)
    g.copy_buffer(kept.still_points, kept.points)
    g.copy_buffer(octree.node_blocks, kept.old_blocks)
    g.copy_buffer(kept.still_nodes, octree.node_blocks)
    g.compute(
        MARK_MOVING,
        reads={"State": octree.state, "Fragments": kept.fragments, "Regions": octree.regions},
        writes={
            "Points": kept.points,
            "MovingPoints": kept.moving_points,
            "Dirty": kept.dirty,
        },
        params=octree.params,
        indirect=(octree.state, state_offset("moving_fragments")),
    )


def _relight(
    g: Graph,
    octree: Octree,
    kept: Kept,
    shadows: ShadowMaps,
    casters: Sequence[Box],
    blocks: range,
) -> None:
    """Leaf points are dirty, too, that see a light through one of the boxes, or in ``blocks``."""
    if not (casters or blocks):
        return
    lights: dict[str, Ref] = shadows.reads()
    corners = np.zeros((2, boxes_max(), 4), np.float32)
    for number, (low, high) in enumerate(casters):
        corners[0, number, :3], corners[1, number, :3] = low, high
    changed = pack(
        layouts().block("ChangedBoxes"),
        low_ws=corners[0],
        high_ws=corners[1],
        count=len(casters),
        first_block=blocks.start,
        end_block=blocks.stop,
    )
    g.compute(
        RELIGHT,
        reads={"Points": kept.points, **lights},
        writes={"Dirty": kept.dirty},
        params={**octree.params, **shadows.params(), "ChangedBoxes": changed},
        threads=octree.grid.grid_blocks(octree.grid.leaf_level + 1),
    )


def _spread_dirty(g: Graph, octree: Octree, kept: Kept) -> None:
    """From dirty leaf points to coarser ones and to nodes, and likewise what is occupied."""
    grid = octree.grid
    for level in range(grid.leaf_level, -1, -1):
        g.compute(
            REDUCE_DIRTY,
            f"reduce.dirty.{level}",
            reads={"Regions": octree.regions},
            writes={
                "Points": kept.points,
                "NodeBlocks": octree.node_blocks,
                "Dirty": kept.dirty,
            },
            params={**octree.params, "OctreeLevel": level_params(level)},
            threads=grid.grid_blocks(level + 1),
        )


def boxes_max() -> int:
    """How many boxes of casters a step looks at; beyond, everything is lit anew."""
    return int(layouts().constant("CHANGED_BOXES_MAX"))


def _give_slots(g: Graph, octree: Octree, kept: Kept) -> None:
    """A slot for every brick and tile."""
    grid, state, params = octree.grid, {"State": octree.state}, octree.params
    blocks, before = {"NodeBlocks": octree.node_blocks}, {"OldBlocks": kept.old_blocks}
    sums = {"KeptSums": kept.kept_sums}
    g.compute(
        SCAN_BLOCKS,
        reads=before,
        writes={**blocks, **sums},
        params=params,
        groups=grid.scan_groups,
    )
    g.compute(
        SCAN_GROUPS,
        reads=before,
        writes={**blocks, **sums, **state},
        params=params,
        groups=1,
    )
    g.compute(SLOT_POOLS, reads={**blocks, **before, **sums}, writes=state, params=params, groups=1)
    free = {"FreeSlots": kept.free_slots}
    g.compute(
        KEEP_SLOTS,
        reads={**before, **sums, **state},
        writes={**blocks, **free},
        params=params,
        threads=max(grid.block_count, octree.capacity.bricks, octree.capacity.tiles),
    )
    g.compute(
        TAKE_SLOTS,
        reads={**before, **sums, **state},
        writes={**blocks, **free},
        params=params,
        threads=grid.block_count,
    )


def list_dirty(g: Graph, octree: Octree, kept: Kept, everything: bool) -> None:
    """Write the nodes; list the voxels and bricks that are dirty, or all of them."""
    step_params = pack(layouts().block("OctreeStep"), everything=everything)
    g.compute(
        NODES,
        reads={
            "Points": kept.points,
            "NodeBlocks": octree.node_blocks,
            "Regions": octree.regions,
            "Dirty": kept.dirty,
        },
        writes={
            "State": octree.state,
            "Nodes": octree.nodes,
            "Bricks": octree.bricks,
            "VoxelList": octree.voxel_list,
        },
        params={**octree.params, "OctreeStep": step_params},
        threads=octree.grid.block_count,
    )
    g.compute(LISTS, writes={"State": octree.state}, params=octree.params, groups=1)


def list_everything(g: Graph, octree: Octree, kept: Kept) -> None:
    """List all voxels and bricks of the last step: for a change of light."""
    g.compute(BEGIN_LISTS, writes={"State": octree.state}, params=octree.params, groups=1)
    list_dirty(g, octree, kept, everything=True)


def _resolve(g: Graph, octree: Octree, kept: Kept) -> None:
    """Leaf attributes of the listed voxels, from still and moving fragments."""
    state, params = {"State": octree.state}, octree.params
    if not octree.grid.one_leaf_level:
        # A coarser leaf lends its empty voxels, too.
        g.clear_buffer(octree.attributes)
        g.clear_buffer(octree.radiance)
    heads, links = {"Heads": kept.heads}, {"Links": kept.links}
    g.compute(
        UNLINK,
        reads=state,
        writes=heads,
        params=params,
        indirect=(octree.state, state_offset("relinked_voxels")),
    )
    for shader, name, threads in (
        (LINK_STILL, "link.still", "relinked_fragments"),
        (LINK_MOVING, "link.moving", "moving_fragments"),
    ):
        g.compute(
            shader,
            name,
            reads={
                **state,
                "Regions": octree.regions,
                "NodeBlocks": octree.node_blocks,
                "Fragments": kept.fragments,
            },
            writes={**heads, **links},
            params=params,
            indirect=(octree.state, state_offset(threads)),
        )
    g.compute(
        RESOLVE,
        reads={**state, "Fragments": kept.fragments, "VoxelList": octree.voxel_list, **links},
        writes={"Attributes": octree.attributes, **heads},
        params=params,
        indirect=(octree.state, state_offset("leaf_voxels")),
    )
