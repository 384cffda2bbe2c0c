"""The pool of transient targets: allocation on demand, reuse by description, lazy release.

[Mittring12 "Compositing Graph"], "RT on demand, ref. counting, lazy release".
"""

from __future__ import annotations

import bisect
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar


class Pooled(Protocol):
    """What the pool needs of a resource."""

    @property
    def serial(self) -> int:
        """Unique number; the lowest free one is handed out first, so frames repeat exactly."""

    @property
    def nbytes(self) -> int:
        """Size in video memory."""

    def release(self) -> None:
        """Free it."""


T = TypeVar("T", bound=Pooled)


@dataclass(slots=True)
class PoolStats:
    """Counts since the pool was made."""

    bytes: int = 0
    """Bytes that the pool holds now, in use or free."""
    high_water: int = 0
    """Largest ``bytes`` so far."""
    in_use: int = 0
    """Resources handed out now."""
    allocations: int = 0
    reuses: int = 0
    freed: int = 0


@dataclass(slots=True)
class _Life(Generic[T]):
    description: Hashable
    resource: T
    made: int
    """Frame of its allocation."""
    reuses: int = 0
    in_use: bool = True


@dataclass(frozen=True, slots=True)
class HeldTarget:
    """One resource of the pool, for those who look at it."""

    memory: int
    """Its serial number."""
    description: Hashable
    nbytes: int
    in_use: bool
    age: int
    """Frames since its allocation."""
    idle: int
    """Frames since its last use."""
    reuses: int


class TargetPool(Generic[T]):
    """Resources by description. ``make(description)`` allocates one."""

    def __init__(self, make: Callable[[Hashable], T], idle_frames: int = 8) -> None:
        self._make = make
        self.idle_frames = idle_frames
        """Frames that a free resource waits before it is released."""
        self.stats = PoolStats()
        self._frame = 0
        self._free: dict[Hashable, list[tuple[int, T]]] = {}
        self._idle_since: dict[int, int] = {}
        """Of what is free: the frame in which it was given back, the longest ago first."""
        self._lives: dict[int, _Life[T]] = {}

    def acquire(self, description: Hashable) -> T:
        """A free resource of ``description``, or a new one."""
        self.stats.in_use += 1
        free = self._free.get(description)
        if free:
            self.stats.reuses += 1
            serial, resource = free.pop(0)
            life = self._lives[serial]
            life.reuses += 1
            life.in_use = True
            del self._idle_since[serial]
            return resource
        try:
            resource = self._make(description)
        except Exception:
            self.stats.in_use -= 1
            raise
        self.stats.allocations += 1
        self.stats.bytes += resource.nbytes
        self.stats.high_water = max(self.stats.high_water, self.stats.bytes)
        self._lives[resource.serial] = _Life(description, resource, self._frame)
        return resource

    def give_back(self, description: Hashable, resource: T) -> None:
        """Return a resource; the next request of the same description may have it."""
        self.stats.in_use -= 1
        self._idle_since[resource.serial] = self._frame
        self._lives[resource.serial].in_use = False
        bisect.insort(self._free.setdefault(description, []), (resource.serial, resource))

    def end_frame(self) -> None:
        """Count a frame and release what lay idle for ``idle_frames``."""
        self._frame += 1
        limit = self._frame - self.idle_frames
        while self._idle_since:
            serial, since = next(iter(self._idle_since.items()))
            if since >= limit:
                return
            life = self._lives[serial]
            free = self._free[life.description]
            free.remove((serial, life.resource))
            if not free:
                del self._free[life.description]
            self._drop(life.resource)

    def clear(self) -> None:
        """Release everything that is free."""
        for free in self._free.values():
            for _, resource in free:
                self._drop(resource)
        self._free.clear()

    def held(self) -> list[HeldTarget]:
        """Everything that the pool holds, in use or free, the oldest first."""
        return [
            HeldTarget(
                serial,
                life.description,
                life.resource.nbytes,
                life.in_use,
                self._frame - life.made,
                0 if life.in_use else self._frame - self._idle_since[serial],
                life.reuses,
            )
            for serial, life in self._lives.items()
        ]

    def _drop(self, resource: T) -> None:
        self.stats.freed += 1
        self.stats.bytes -= resource.nbytes
        del self._idle_since[resource.serial], self._lives[resource.serial]
        resource.release()
