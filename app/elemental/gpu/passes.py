"""What a recorded pass holds until it runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from elemental.gpu.program import Program
from elemental.gpu.state import RasterState

if TYPE_CHECKING:
    from elemental.gpu.binding import Look
    from elemental.gpu.encode import Encoder

Attachment = tuple[int, int, int]
"""(resource, level, layer or -1)."""


class Pass:
    """Resources by index into the graph's table; see plan.PlannedPass."""

    __slots__ = (
        "accesses", "bindings", "has_side_effect", "modifies", "name", "overwrites", "params",
        "reads",
    )  # fmt: skip

    def __init__(self, name: str) -> None:
        self.name = name
        self.reads: list[int] = []
        self.modifies: list[int] = []
        self.overwrites: list[int] = []
        self.has_side_effect = False
        self.accesses: list[tuple[int, int, int]] = []
        """(resource, barrier bit of the use, shader write)."""
        self.bindings: list[tuple[Look, int]] = []
        self.params: list[tuple[int, int, int]] = []
        """(uniform binding, offset in the frame's segment, bytes)."""


class ComputePass(Pass):
    """A dispatch."""

    __slots__ = ("groups", "indirect", "program")

    def __init__(self, name: str, program: Program) -> None:
        super().__init__(name)
        self.program = program
        self.groups = (0, 0, 0)
        self.indirect: tuple[int, int] | None = None


class RasterPass(Pass):
    """Draws into targets."""

    __slots__ = (
        "clear_depth", "clear_stencil", "color", "depth", "draw", "instances", "missing",
        "program", "size", "state", "tile", "vertices", "viewport",
    )  # fmt: skip

    def __init__(self, name: str, program: Program, state: RasterState) -> None:
        super().__init__(name)
        self.program, self.state = program, state
        self.color: list[tuple[int, int, int, tuple[float, ...] | None]] = []
        """Attachments, each with its clear colour."""
        self.depth: Attachment | None = None
        self.clear_depth: float | None = None
        self.clear_stencil: int | None = None
        self.missing: frozenset[str] = frozenset()
        self.size = (0, 0)
        self.viewport = (0, 0, 0, 0)
        self.tile: tuple[int, int, int, int] | None = None
        self.draw: Callable[[Encoder], None] | None = None
        self.vertices = 3
        self.instances = 1


class ClearTexture(Pass):
    """A fill of a whole texture."""

    __slots__ = ("color", "resource")

    def __init__(self, name: str, resource: int, color: tuple[float, ...]) -> None:
        super().__init__(name)
        self.resource, self.color = resource, color


class ClearBuffer(Pass):
    """A fill of a range of a buffer."""

    __slots__ = ("length", "offset", "resource", "value")

    def __init__(self, name: str, resource: int, value: int, offset: int, length: int) -> None:
        super().__init__(name)
        self.resource, self.value, self.offset, self.length = resource, value, offset, length


class Copy(Pass):
    """A copy between two buffers (``span``: source offset, target offset, bytes), or of textures,
    of a ``layer`` or of a ``tile``."""

    __slots__ = ("layer", "source", "span", "target", "tile")

    def __init__(self, name: str, source: int, target: int) -> None:
        super().__init__(name)
        self.source, self.target = source, target
        self.span: tuple[int, int, int] | None = None
        self.layer: int | None = None
        self.tile: tuple[int, int, int, int] | None = None


class Readback(Pass):
    """A copy to the CPU that arrives frames later; always runs."""

    __slots__ = ("callback", "nbytes", "resource")

    def __init__(
        self, name: str, resource: int, nbytes: int, callback: Callable[[bytes], None]
    ) -> None:
        super().__init__(name)
        self.resource, self.nbytes, self.callback = resource, nbytes, callback
        self.has_side_effect = True
