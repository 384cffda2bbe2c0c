"""Keeps the octree true to the scene and its light, doing only what a change asks for."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from elemental.core.layout import Block
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.passes.light_cells import cull_to_world
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.voxel import sizing
from elemental.passes.voxel.build import build
from elemental.passes.voxel.grid import Grid
from elemental.passes.voxel.kept import Kept, carry_still, keep_still, mark_still
from elemental.passes.voxel.ladder import Ladder
from elemental.passes.voxel.light import compress, filter_levels, light_voxels
from elemental.passes.voxel.octree import Capacity, Counts, Octree
from elemental.passes.voxel.steps import (
    NO_BLOCKS,
    boxes_max,
    list_everything,
    refresh,
    step,
)
from elemental.passes.voxel.voxelize import voxelize

if TYPE_CHECKING:
    from elemental.passes.decal_voxels import DecalVoxels
    from elemental.passes.shadow import ShadowMaps
    from elemental.passes.sky import Sky

SLICES = 8
"""Parts of the leaf voxels of which each spread gather does one: octants of the scene."""
NOTHING = Counts(0, 0, 0, 0, 0, 0, 0, 0, 0, 0)


class VoxelLighting:
    """The octree of a scene with what it was built from and lit by.

    ``area_m2``: `sizing.projected_area`; ``capacity``: None counts first and allocates to fit.
    ``coarser``: grids to fall back to, one after the other, where no pools hold what ``grid`` asks
    for.
    ``decals`` colour what is built. Where parts of the scene can move, the octree is built in steps
    (`steps`).
    """

    def __init__(
        self,
        device: Device,
        scene: GpuScene,
        grid: Grid,
        area_m2: float,
        max_emission: float,
        budget_bytes: int,
        capacity: Capacity | None = None,
        decals: DecalVoxels | None = None,
        coarser: Sequence[Grid] = (),
    ) -> None:
        self.device = device
        self.scene = scene
        self.decals = decals
        self.budget_bytes = budget_bytes
        self._area_m2 = area_m2
        self._ladder = Ladder((grid, *coarser))
        self._moves = bool(scene.dynamic.any())
        self._dynamic = scene.dynamic.tobytes()
        if capacity is None:
            grid, capacity = self._finest_that_fits()
        self._allocate(grid, capacity, max_emission)
        self.counts = NOTHING
        self._built_version: int | None = None
        self._lit_by: Hashable = None
        self.version = 0
        """Counts the updates that changed what the octree holds."""
        self._regridded = False
        self._slice = 0
        self._unsettled = 0

    def _allocate(self, grid: Grid, capacity: Capacity, max_emission: float) -> None:
        self.octree = Octree(self.device, grid, capacity, max_emission, keeps_slots=self._moves)
        self._kept = Kept(self.device, self.octree) if self._moves else None

    def invalidate(self, what: str) -> None:
        """Make the next update rebuild the "geometry", or only relight: "light"."""
        self._lit_by = None
        if what == "geometry":
            self._built_version = None

    def _finest_that_fits(self) -> tuple[Grid, Capacity]:
        count = partial(sizing.count, self.device, self.scene, area_m2=self._area_m2)
        return self._ladder.descend(count, self._holds)

    def _holds(self, grid: Grid, counts: Counts) -> tuple[Capacity, bool]:
        """Pools for what a grid asks for, and whether they hold it all."""
        room = self._room_for(counts)
        return room, sizing.holds_all(room, counts, grid.one_leaf_level, self._moves)

    def refit(self) -> None:
        """Before a frame: take a coarser grid where the last counted build overflowed and no pools
        could hold it, and the finer one again where they could. Counts with a wait, since pools of
        a new grid have to be made; frames that keep theirs wait for nothing."""
        if self.counts == NOTHING or not self._ladder.has_to_move(self.counts, self._holds):
            return
        grid, capacity = self._finest_that_fits()
        self.release()
        self._allocate(grid, capacity, self.octree.max_emission)
        self.counts = NOTHING
        self._built_version = self._lit_by = None
        self._regridded = False

    def set_grid(self, grid: Grid, coarser: Sequence[Grid] = ()) -> bool:
        """Take other regions' leaf levels from the next frame on; ``coarser`` as when it was made.
        Returns whether it can.

        It can where fragments are kept, stay on the same finest lattice, and fit: they are marked
        anew in pools of the size that they ask for. It is counted, with a wait; nothing is drawn.
        """
        old, kept = self.octree, self._kept
        on_lattice = (grid.leaf_level, grid.size, *grid.origin) == (
            old.grid.leaf_level, old.grid.size, *old.grid.origin
        )  # fmt: skip
        if kept is None or self._built_version is None or not on_lattice:
            return False
        room, holds_all = self._holds(grid, sizing.count_again(old, grid, kept.fragments))
        if not holds_all or self._ladder.dropped:
            return False
        self._ladder = Ladder((grid, *coarser))
        room = replace(room, fragments=old.capacity.fragments)
        self._allocate(grid, room, old.max_emission)
        assert self._kept is not None
        g = self.device.begin_frame()
        carry_still(g, old, kept, self.octree, self._kept)
        g.execute()
        old.release()
        kept.release()
        self._lit_by, self._regridded = None, True
        return True

    def update(
        self,
        g: Graph,
        shadows: ShadowMaps,
        sky: Sky,
        area_lights: Block,
        light_key: Hashable,
        bounces: int,
        spread: bool = False,
    ) -> Octree:
        """Add the passes that this frame needs: none where nothing changed.

        ``light_key`` is equal as long as lights and sky are, whatever moves; ``bounces`` counts
        gathers: voxel radiance holds light gathered ``bounces - 1`` times. ``spread``: where things
        move, one gather a frame of what the octree held in the last, of what changed and of a slice
        of the rest, until light has gone round ``bounces`` times since.
        """
        self._divide()
        gathers = bounces > 1
        # Area lights reach voxels by gathering alone.
        key = (light_key, bounces, area_lights.tobytes() if gathers else b"")
        lit_anew = key != self._lit_by
        built = self._built_version != self.scene.version or self._regridded
        whole = self._lit_by is None
        # Beside regions of other levels no slice can be done by itself.
        spread &= gathers and self._kept is not None and self.octree.grid.one_leaf_level
        if built:
            whole |= self._grow()
            if self._kept is None:
                queue = voxelize(g, self.scene, self.octree, self.decals)
                build(g, self.octree, queue)
            else:
                everything = lit_anew or (gathers and not spread)
                blocks = self._next_slice() if spread else NO_BLOCKS
                whole |= self._step(g, self._kept, shadows, everything, blocks)
            g.read_later(self.octree.state, partial(self._counted, self.octree))
            self._built_version = self.scene.version
        elif lit_anew and self._kept is not None:
            list_everything(g, self.octree, self._kept)
        elif self._unsettled and spread and self._kept is not None:
            refresh(g, self.octree, self._kept, shadows, self._next_slice())
        if built or lit_anew:
            self._unsettled = SLICES * bounces if spread and not whole else 0
        elif self._unsettled and spread:
            self._unsettled -= 1
        else:
            return self.octree
        self.version += 1
        sided = self._kept.sided if self._kept is not None else None
        spread &= not whole
        cells = cull_to_world(g, shadows, self.octree.grid)
        for bounce in (1,) if spread else range(max(bounces, 1)):
            light_voxels(
                g,
                self.octree,
                shadows,
                sky,
                area_lights,
                gather=bounce > 0,
                of_last_frame=spread,
                cells=cells,
            )
            compress(g, self.octree, filter_levels(g, self.octree, sided))
        self._lit_by = key
        return self.octree

    def _divide(self) -> None:
        """Build anew where other instances than before count as dynamic, in steps from now on."""
        if self._dynamic == self.scene.dynamic.tobytes():
            return
        self._dynamic = self.scene.dynamic.tobytes()
        self.invalidate("geometry")
        if not self._moves:
            octree, self._moves = self.octree, True
            self.release()
            known = self.counts != NOTHING
            room = self._room_for(self.counts) if known else octree.capacity
            self._allocate(octree.grid, room, octree.max_emission)

    def _next_slice(self) -> range:
        """Blocks of leaf points, another eighth each time."""
        grid = self.octree.grid
        blocks = grid.grid_blocks(grid.leaf_level + 1)
        self._slice = (self._slice + 1) % SLICES
        return range(self._slice * blocks // SLICES, (self._slice + 1) * blocks // SLICES)

    def _step(
        self, g: Graph, kept: Kept, shadows: ShadowMaps, everything: bool, blocks: range
    ) -> bool:
        """What moved since the last build. Returns whether that was not known, or more changed, so
        that the octree was built whole."""
        changes = self.scene.changes
        since = self.scene.version - (self._built_version or 0)
        stands = since == 0 or all(self.scene.dynamic[change.instance] for change in changes)
        whole = not (self._built_version is not None and since <= 1 and stands)
        if whole:
            keep_still(g, self.scene, self.octree, kept, self.decals)
        elif self._regridded:
            mark_still(g, self.octree, kept)
            whole = True
        self._regridded = False
        boxes = [box for c in changes if c.casts for box in (c.before, c.after) if box]
        # Beside regions of other levels voxels depend on more than their own surroundings.
        several = not self.octree.grid.one_leaf_level
        everything |= whole or several or len(boxes) > boxes_max()
        step(g, self.scene, self.octree, kept, shadows, boxes, everything, blocks, self.decals)
        return whole

    def _counted(self, octree: Octree, raw: bytes) -> None:
        if octree is not self.octree:
            return  # of pools that are gone
        self.counts = Counts.from_state(raw)
        if self._larger() is not None:
            self.invalidate("geometry")

    def _larger(self) -> Capacity | None:
        """Pools for what was counted, where the last build had to drop some of it and the budget
        allows for so much more that they are worth a whole build."""
        if not self.counts.overflowed:
            return None
        octree, wanted = self.octree, self._room_for(self.counts)
        one_leaf_level = octree.grid.one_leaf_level
        if sizing.is_worth_it(wanted, octree.capacity, self.counts, one_leaf_level, self._moves):
            return wanted
        return None

    def _room_for(self, counts: Counts) -> Capacity:
        if self._moves:
            return sizing.capacity_in_motion(counts, self.budget_bytes, self.device.storage_limit)
        return sizing.capacity_for(
            counts, self.budget_bytes, storage_bytes=self.device.storage_limit
        )

    def _grow(self) -> bool:
        """Take larger pools where they are worth it."""
        larger = self._larger()
        if larger is None:
            return False
        octree = self.octree
        self.release()
        self._allocate(octree.grid, larger, octree.max_emission)
        self._built_version = self._lit_by = None
        return True

    def counters(self) -> dict[str, int]:
        """What the newest counted build holds and what it had to drop."""
        counts, grid = self.counts, self.octree.grid
        return {
            "voxel_fragments": counts.fragments,
            "voxel_fragments_dropped": counts.fragments_dropped,
            "octree_nodes": grid.dense_nodes + 8 * counts.tiles,
            "octree_nodes_dropped": 8 * counts.tiles_dropped,
            "octree_bricks": counts.bricks,
            "octree_bricks_dropped": counts.bricks_dropped,
            "octree_leaf_bricks": counts.leaves,
            "octree_resolution": grid.resolution,
            "octree_levels_dropped": self._ladder.dropped,
        }

    def release(self) -> None:
        """Free the octree."""
        self.octree.release()
        if self._kept is not None:
            self._kept.release()
