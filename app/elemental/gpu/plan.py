"""Planning a frame without GL: what runs, in which order, for how long a target lives, barriers.

A pass declares what it reads, modifies (keeping what was there) and overwrites. Declaration order
gives each resource its versions; the order of execution comes from the dependencies alone.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Hashable, Sequence
from typing import Any, NamedTuple, Protocol


class PlanError(Exception):
    """A graph that can't be ordered: a cycle, or a target that is read and never written."""


class PlannedPass(Protocol):
    """What the planner needs of a pass; a resource is whatever tells it from the others."""

    @property
    def name(self) -> str:
        """Name in messages."""

    @property
    def reads(self) -> Sequence[Hashable]:
        """Resources whose present content is used."""

    @property
    def modifies(self) -> Sequence[Hashable]:
        """Resources that are written and keep what is not written."""

    @property
    def overwrites(self) -> Sequence[Hashable]:
        """Resources whose earlier content is lost."""

    @property
    def has_side_effect(self) -> bool:
        """True where the pass must run even if nothing reads what it writes."""


class Schedule(NamedTuple):
    """The passes that run and the resources they bring to life."""

    order: list[int]
    """Indices of the live passes in the order of execution."""
    culled: list[int]
    """Indices of the passes that nobody needs."""
    births: list[list[Any]]
    """For each position of ``order``: transient resources first used there."""
    deaths: list[list[Any]]
    """For each position of ``order``: transient resources last used there, not kept."""


def schedule(
    passes: Sequence[PlannedPass],
    name_of: Callable[[Any], str],
    persistent: Collection[Hashable],
    kept: Collection[Hashable],
) -> Schedule:
    """Cull and order ``passes``.

    ``name_of``: a resource's name in messages; ``persistent`` ones outlive the frame, so their
    writers always run; ``kept`` ones are the frame's outputs. A transient that is read before any
    pass wrote it, in declaration order, is read in its final version, so its writers run first.
    Raises PlanError for a cycle or for a transient that is read or kept and never written.
    """
    needs, late = _needs(passes, name_of, persistent)
    live, unwritten = _live(passes, needs, persistent, kept)
    for resource in kept:
        if resource in unwritten and resource not in persistent:
            raise PlanError(f"{name_of(resource)} is kept, but no pass writes it")
    order = [index for index, alive in enumerate(live) if alive]
    if late:
        order = _sorted(passes, order, needs, _follows(passes, persistent))
    births, deaths = _lifetimes(passes, order, persistent, kept)
    culled = [index for index, alive in enumerate(live) if not alive]
    return Schedule(order, culled, births, deaths)


def _needs(
    passes: Sequence[PlannedPass],
    name_of: Callable[[Any], str],
    persistent: Collection[Hashable],
) -> tuple[list[set[int]], bool]:
    """(passes whose results each pass uses, whether a read precedes its write)."""
    needs: list[set[int]] = []
    writer: dict[Hashable, int] = {}
    early_reads: dict[Hashable, list[int]] = {}
    for index, item in enumerate(passes):
        need: set[int] = set()
        for resource in item.reads:
            if resource in writer:
                need.add(writer[resource])
            elif resource not in persistent:
                early_reads.setdefault(resource, []).append(index)
        for resource in item.modifies:
            if resource in writer:
                need.add(writer[resource])
            writer[resource] = index
        for resource in item.overwrites:
            writer[resource] = index
        need.discard(index)
        needs.append(need)
    for resource, indices in early_reads.items():
        final = writer.get(resource)
        if final is None or indices == [final]:
            reader = passes[indices[0]].name
            raise PlanError(f"pass {reader} reads {name_of(resource)}, which no pass writes")
        for index in indices:
            needs[index].add(final)
    return needs, bool(early_reads)


def _follows(passes: Sequence[PlannedPass], persistent: Collection[Hashable]) -> list[set[int]]:
    """Passes that each pass must not overtake, as it destroys what they read or wrote."""
    follows: list[set[int]] = []
    writer: dict[Hashable, int] = {}
    readers: dict[Hashable, list[int]] = {}
    for index, item in enumerate(passes):
        follow = {writer[r] for r in item.overwrites if r in writer}
        for resource in item.reads:
            if resource in writer or resource in persistent:
                readers.setdefault(resource, []).append(index)
        for resource in (*item.modifies, *item.overwrites):
            follow.update(readers.pop(resource, ()))
            writer[resource] = index
        follow.discard(index)
        follows.append(follow)
    return follows


def _live(
    passes: Sequence[PlannedPass],
    needs: list[set[int]],
    persistent: Collection[Hashable],
    kept: Collection[Hashable],
) -> tuple[list[bool], set[Hashable]]:
    """(whether each pass runs, kept resources that none writes)."""
    live = [False] * len(passes)
    stack: list[int] = []
    unclaimed = set(kept)
    for index in range(len(passes) - 1, -1, -1):
        item = passes[index]
        root = item.has_side_effect
        for written in (item.modifies, item.overwrites):
            for resource in written:
                if resource in unclaimed:
                    unclaimed.discard(resource)
                    root = True
                elif resource in persistent:
                    root = True
        if root:
            stack.append(index)
    while stack:
        index = stack.pop()
        if not live[index]:
            live[index] = True
            stack.extend(needs[index])
    return live, unclaimed


def _sorted(
    passes: Sequence[PlannedPass],
    live: list[int],
    needs: list[set[int]],
    follows: list[set[int]],
) -> list[int]:
    """Topological order of the live passes; among ready ones the first declared goes first."""
    alive = set(live)
    waiting = {index: (needs[index] | follows[index]) & alive for index in live}
    unblocks: dict[int, list[int]] = {}
    for index, before in waiting.items():
        for earlier in before:
            unblocks.setdefault(earlier, []).append(index)
    ready = [index for index in live if not waiting[index]]
    heapq.heapify(ready)
    order: list[int] = []
    while ready:
        index = heapq.heappop(ready)
        order.append(index)
        for later in unblocks.get(index, ()):
            waiting[later].discard(index)
            if not waiting[later]:
                heapq.heappush(ready, later)
    if len(order) < len(live):
        stuck = ", ".join(passes[index].name for index in live if waiting[index])
        raise PlanError(f"passes wait for each other: {stuck}")
    return order


def _lifetimes(
    passes: Sequence[PlannedPass],
    order: list[int],
    persistent: Collection[Hashable],
    kept: Collection[Hashable],
) -> tuple[list[list[Any]], list[list[Any]]]:
    births: list[list[Any]] = [[] for _ in order]
    deaths: list[list[Any]] = [[] for _ in order]
    last: dict[Hashable, int] = {}
    for position, index in enumerate(order):
        item = passes[index]
        for used in (item.reads, item.modifies, item.overwrites):
            for resource in used:
                if resource in persistent:
                    continue
                if resource not in last:
                    births[position].append(resource)
                last[resource] = position
    for resource, position in last.items():
        if resource not in kept:
            deaths[position].append(resource)
    return births, deaths


UNORDERED = 2
"""A shader write, as ``Access`` has it, that may overtake others of its kind."""


class Tracked(Protocol):
    """A physical resource with the clock of its last shader write, of its last unordered write, and
    of its last access but for those."""

    written_at: int
    unordered_at: int
    ordered_at: int


_BITS = 16
"""Of glMemoryBarrier, GL 4.4's included."""


class Hazards:
    """Which barrier bits must precede each pass, over all frames of a device.

    glMemoryBarrier acts on everything at once, so a resource needs a bit only where that bit was
    not issued since the resource's last shader write (read or write after write) or, before a
    shader write, since its last access of any kind (write after read) [GL 4.3, 7.12.2]. Unordered
    writes don't wait for each other.
    """

    __slots__ = ("_issued", "clock")

    def __init__(self) -> None:
        self.clock = 1
        self._issued = {1 << number: 0 for number in range(_BITS)}

    def barrier_before(self, accesses: Sequence[tuple[Tracked, int, int]]) -> int:
        """Bits to issue before a pass that makes ``accesses`` (state, bit, shader write or 0)."""
        issued = self._issued
        bits = 0
        for state, bit, shader_write in accesses:
            if not shader_write:
                since = state.written_at
            elif shader_write == UNORDERED:
                since = state.ordered_at
            else:
                since = max(state.ordered_at, state.unordered_at)
            if since > issued[bit]:
                bits |= bit
        if bits:
            self.issued(bits)
        self.clock = now = self.clock + 1
        for state, _, shader_write in accesses:
            if shader_write:
                state.written_at = now
            if shader_write == UNORDERED:
                state.unordered_at = now
            else:
                state.ordered_at = now
        return bits

    def touched(self, state: Tracked) -> None:
        """Note an access outside of passes: an upload."""
        self.clock += 1
        state.ordered_at = self.clock

    def issued(self, bits: int) -> None:
        """Note that a barrier of ``bits`` was issued now."""
        while bits:
            lowest = bits & -bits
            self._issued[lowest] = self.clock
            bits ^= lowest
