"""What a recorded pass holds until it runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from elemental.gpu.refs import Resource
from elemental.gpu.state import RasterState
from elemental.gpu.uses import Bound, Uses

if TYPE_CHECKING:
    from elemental.gpu.encode import Encoder

Placed = tuple[int, int, int]
"""A uniform block: (its binding, offset in the frame's segment, bytes)."""


class Pass:
    """A name, what is used, and what this frame alone says of it; see plan.PlannedPass."""

    __slots__ = ("bound", "name", "params", "uses")

    def __init__(self, name: str, uses: Uses, params: Sequence[Placed] = ()) -> None:
        self.name, self.uses, self.params = name, uses, params
        self.bound: Bound | None = None
        """The GL objects behind ``uses``, while the graph runs."""

    @property
    def reads(self) -> Sequence[Resource]:
        """Resources whose present content is used."""
        return self.uses.reads

    @property
    def modifies(self) -> Sequence[Resource]:
        """Resources that are written and keep what is not written."""
        return self.uses.modifies

    @property
    def overwrites(self) -> Sequence[Resource]:
        """Resources whose earlier content is lost."""
        return self.uses.overwrites

    @property
    def has_side_effect(self) -> bool:
        """True where the pass must run even if nothing reads what it writes."""
        return self.uses.has_side_effect


class ComputePass(Pass):
    """A dispatch."""

    __slots__ = ("groups", "indirect")

    def __init__(self, name: str, uses: Uses, params: Sequence[Placed]) -> None:
        Pass.__init__(self, name, uses, params)
        self.groups = (0, 0, 0)
        self.indirect: int | None = None
        """Byte offset of the group counts in the buffer that is used last."""


class RasterPass(Pass):
    """Draws into targets."""

    __slots__ = (
        "clear_depth", "clear_stencil", "clears", "draw", "instances", "state", "tile",
        "vertices", "viewport",
    )  # fmt: skip

    def __init__(
        self,
        name: str,
        uses: Uses,
        params: Sequence[Placed],
        state: RasterState,
    ) -> None:
        Pass.__init__(self, name, uses, params)
        self.state = state
        self.clears: Sequence[tuple[float, ...] | None] = ()
        """Of each colour target; empty where none is cleared."""
        self.clear_depth: float | None = None
        self.clear_stencil: int | None = None
        self.viewport = (0, 0, 0, 0)
        self.tile: tuple[int, int, int, int] | None = None
        self.draw: Callable[[Encoder], None] | None = None
        self.vertices = 3
        self.instances = 1


class ClearTexture(Pass):
    """A fill of a whole texture."""

    __slots__ = ("color",)

    def __init__(self, name: str, uses: Uses, color: tuple[float, ...]) -> None:
        Pass.__init__(self, name, uses)
        self.color = color


class ClearBuffer(Pass):
    """A fill of a range of a buffer with one word, or with four over and over."""

    __slots__ = ("length", "offset", "words")

    def __init__(
        self, name: str, uses: Uses, words: tuple[int, ...], offset: int, length: int
    ) -> None:
        Pass.__init__(self, name, uses)
        self.words, self.offset, self.length = words, offset, length


class Copy(Pass):
    """A copy of what is used first to what is used second: between two buffers (``span``: source
    offset, target offset, bytes), or of textures, of a ``layer`` or of a ``tile``."""

    __slots__ = ("layer", "span", "tile")

    def __init__(self, name: str, uses: Uses) -> None:
        Pass.__init__(self, name, uses)
        self.span: tuple[int, int, int] | None = None
        self.layer: int | None = None
        self.tile: tuple[int, int, int, int] | None = None


class Readback(Pass):
    """A copy to the CPU that arrives frames later; always runs."""

    __slots__ = ("callback",)

    def __init__(self, name: str, uses: Uses, callback: Callable[[bytes], None]) -> None:
        Pass.__init__(self, name, uses)
        self.callback = callback
