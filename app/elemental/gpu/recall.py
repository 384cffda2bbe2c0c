"""What frames have in common: handles, uses and plans, found again by what is asked for."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar

from elemental.gpu.refs import BufferHandle, TextureHandle

if TYPE_CHECKING:
    from elemental.gpu.binder import Binding
    from elemental.gpu.frame_plan import FramePlan
    from elemental.gpu.uses import Uses

GENERATION = 16
"""Frames after which what was not asked for grows old; a second such span forgets it. Long enough
for what comes back every few frames, short enough for a window that is being resized."""

Drawn: TypeAlias = "tuple[Sequence[tuple[Any, int, int]], Sequence[Binding]]"
"""(accesses, bindings) of what a draw callback binds."""
V = TypeVar("V")
H = TypeVar("H", TextureHandle, BufferHandle)


class Recent(Generic[V]):
    """A dictionary that forgets what nobody asked for during one to two generations of frames."""

    __slots__ = ("_old", "_young")

    def __init__(self) -> None:
        self._young: dict[Hashable, V] = {}
        self._old: dict[Hashable, V] = {}

    def get(self, key: Hashable) -> V | None:
        """What is known by ``key``."""
        value = self._young.get(key)
        if value is None:
            value = self._old.get(key)
            if value is not None:
                self._young[key] = value
        return value

    def __setitem__(self, key: Hashable, value: V) -> None:
        self._young[key] = value

    def __len__(self) -> int:
        return len(self._young.keys() | self._old.keys())

    def grow_old(self) -> None:
        """End a generation."""
        self._old, self._young = self._young, {}

    def clear(self) -> None:
        """Forget everything."""
        self._old, self._young = {}, {}


class _Namesakes:
    """Handles that are declared alike, in the order of their declaration in a frame."""

    __slots__ = ("frame", "given", "handles")

    def __init__(self) -> None:
        self.handles: list[Any] = []
        self.frame = self.given = 0


class Recall:
    """The memory of a device's graphs. Frames that declare alike meet the same objects in it.

    Every object in it is made of its key alone, so that forgetting costs time and nothing else.
    """

    def __init__(self) -> None:
        self.uses: Recent[Uses] = Recent()
        """By program and references."""
        self.plans: Recent[FramePlan] = Recent()
        """By the uses of all passes and the frame's outputs."""
        self.draws: Recent[Drawn] = Recent()
        """By slot and reference: what draw callbacks bind."""
        self._handles: Recent[_Namesakes] = Recent()
        self._known: tuple[Recent[Any], ...] = (self.uses, self.plans, self.draws, self._handles)
        self._frame = 0

    def begin_frame(self) -> None:
        """Count a frame: its handles are given out from the first again."""
        self._frame += 1
        if self._frame % GENERATION == 0:
            for known in self._known:
                known.grow_old()

    def handle(self, make: Callable[..., H], *declared: Hashable) -> H:
        """This frame's next handle that is declared so; where there is none yet, ``make`` makes it
        of the same arguments."""
        key = (make, declared)
        met = self._handles.get(key)
        if met is None:
            met = self._handles[key] = _Namesakes()
        if met.frame != self._frame:
            met.frame, met.given = self._frame, 0
        if met.given == len(met.handles):
            met.handles.append(make(*declared))
        handle: H = met.handles[met.given]
        met.given += 1
        return handle

    def clear(self) -> None:
        """Forget everything."""
        for known in self._known:
            known.clear()
