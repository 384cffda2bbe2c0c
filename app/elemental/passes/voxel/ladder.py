"""Which of several grids of a scene its octree has: the finest whose pools hold everything."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from elemental.passes.voxel import sizing
from elemental.passes.voxel.grid import Grid
from elemental.passes.voxel.octree import Capacity, Counts

Holds = Callable[[Grid, Counts], tuple[Capacity, bool]]
"""Pools for what a grid asks for, within budget and driver, and whether they hold it all."""
CLIMB_SLACK = 1.1
"""Room that a finer grid's pools must have left before it is tried again [inferred: more than a
scene's need changes from frame to frame, so that it does not go up and down by turns]."""


class Ladder:
    """Grids of one scene, finest first, and the one that stands.

    Pools that can't hold a grid's leaves would leave holes in walls; a coarser grid has none.
    """

    def __init__(self, grids: Sequence[Grid]) -> None:
        self.grids = tuple(grids)
        self.dropped = 0
        """How many leaf levels the one that stands lacks."""
        self._asked: list[Counts] = []

    def descend(self, count: Callable[[Grid], Counts], holds: Holds) -> tuple[Grid, Capacity]:
        """The finest grid whose pools hold what it asks for, where none is, the last; its pools."""
        self._asked = []
        for dropped, grid in enumerate(self.grids):
            self.dropped = dropped
            self._asked.append(count(grid))
            room, whole = holds(grid, self._asked[-1])
            if whole:
                break
        return grid, room

    def has_to_move(self, counts: Counts, holds: Holds) -> bool:
        """Whether another grid may suit a scene that asked for this much on the one that stands."""
        if counts.overflowed:
            is_last = self.dropped + 1 == len(self.grids)
            return not is_last and not holds(self.grids[self.dropped], counts)[1]
        if self.dropped == 0:
            return False
        finer, here = self._asked[self.dropped - 1], self._asked[self.dropped]
        growth = CLIMB_SLACK * counts.bricks / max(here.bricks, 1)
        return holds(self.grids[self.dropped - 1], sizing.with_slack(finer, growth))[1]
