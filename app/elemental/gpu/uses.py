"""What a pass reads and writes, and where each of it is bound: the part that frames share.

It depends on the program and on the references given alone, so it is worked out and checked once;
a frame like the one before only finds it again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from elemental.gpu import gl as c
from elemental.gpu.arguments import refuse_feedback, target_parts
from elemental.gpu.binding import GraphError, Look, Params, looks, name_plan
from elemental.gpu.plan import UNORDERED
from elemental.gpu.program import Program, Slot
from elemental.gpu.refs import (
    AnyBuffer,
    AnyHandle,
    AnyTexture,
    BufferHandle,
    ImageRef,
    Ref,
    Resource,
    TextureHandle,
    Unordered,
)
from elemental.gpu.resources import Buffer, Texture
from elemental.gpu.shape import level_size

if TYPE_CHECKING:
    from elemental.gpu.binder import Binding
    from elemental.gpu.graph import Graph
    from elemental.gpu.targets import Attached

Attachment = tuple[AnyTexture, int, int]
"""(texture, level, layer or -1)."""


class Bound(NamedTuple):
    """The GL objects behind the uses of a pass."""

    accesses: Sequence[tuple[Any, int, int]]
    """(physical resource, barrier bit of the use, shader write)."""
    bindings: Sequence[Binding]
    color: Sequence[Attached]
    depth: Attached | None
    framebuffer: int


class Uses:
    """Resources by what is done with them; see plan.PlannedPass."""

    __slots__ = (
        "_program", "accesses", "bindings", "blocks", "bound", "color", "depth", "groups",
        "handles", "has_side_effect", "missing", "modifies", "overwrites", "reads", "renders",
        "size", "targets", "threads",
    )  # fmt: skip

    def __init__(self, program: Program | None = None) -> None:
        self._program = program
        self.reads: list[Resource] = []
        self.modifies: list[Resource] = []
        self.overwrites: list[Resource] = []
        self.has_side_effect = False
        self.accesses: list[tuple[Resource, int, int]] = []
        """(resource, barrier bit of the use, shader write)."""
        self.bindings: list[tuple[Look, Resource]] = []
        self.blocks: tuple[Slot, ...] = ()
        """Uniform blocks, in the order in which the pass gives their values."""
        self.missing: frozenset[str] = frozenset()
        """Names that a draw callback has to bind."""
        self.color: list[Attachment] = []
        self.depth: Attachment | None = None
        self.renders = False
        """Whether it draws, into targets or into none."""
        self.size = (0, 0)
        """Of the targets, px."""
        self.threads: object = None
        self.groups = (0, 0, 0)
        """Work groups of a dispatch of so many ``threads``."""
        self.handles: list[AnyHandle] | None = None
        self.targets: list[Texture | Buffer | None] = []
        """What the handles were when ``bound`` was made."""
        self.bound: Bound | None = None

    @property
    def program(self) -> Program:
        """Of a dispatch or a draw."""
        assert self._program is not None, "clears, copies and read-backs have none"
        return self._program

    def transients(self) -> list[AnyHandle]:
        """The handles among the resources."""
        if self.handles is None:
            used = dict.fromkeys((*self.reads, *self.modifies, *self.overwrites))
            self.handles = [item for item in used if isinstance(item, AnyHandle)]
        return self.handles

    def use(
        self,
        graph: Graph,
        reads: Mapping[str, Ref],
        writes: Mapping[str, Ref],
        params: Params,
    ) -> None:
        """Note what the program is given by its names. Raises GraphError for what does not fit."""
        program = self.program
        plan = name_plan(program, reads, writes, params)
        self.blocks, self.missing = plan.params, plan.missing
        for slots, refs, used, written in (
            (plan.reads, reads, self.reads, False),
            (plan.writes, writes, self.modifies, True),
        ):
            for slot, given in zip(slots, refs.values(), strict=True):
                ref, access = given, int(written)
                if isinstance(given, Unordered):
                    ref, access = given.buffer, UNORDERED * access
                for look, resource in looks(slot, ref, program):
                    check_owner(graph, resource)
                    used.append(resource)
                    if slot.unit >= 0:
                        self.bindings.append((look, resource))
                        self.accesses.append((resource, look.barrier, access))

    def read_buffers(self, graph: Graph, buffers: Sequence[AnyBuffer]) -> None:
        """Note buffers that are read by other ways than a program's names."""
        for buffer in buffers:
            check_owner(graph, buffer)
            self.reads.append(buffer)

    def attach(
        self, graph: Graph, name: str, target: ImageRef, *, cleared: bool, written: bool = True
    ) -> Attachment:
        """Note how a render target is used; all targets of a pass, ``name``, have one size."""
        texture, level, layer = target_parts(target)
        check_owner(graph, texture)
        desc = texture.desc
        if texture in self.reads or texture in self.modifies:
            refuse_feedback(name, self.bindings, (texture, level, layer))
        if cleared and desc.mips == 1 and (layer < 0 or desc.slices == 1):
            self.overwrites.append(texture)
        elif written or cleared:
            self.modifies.append(texture)
        else:
            self.reads.append(texture)
        self.accesses.append((texture, c.FRAMEBUFFER_BARRIER, 0))
        width, height = level_size(desc.size, level)[:2]
        if self.size not in ((0, 0), (width, height)):
            raise GraphError(f"{name}: {texture.name} is {width}x{height}, not {self.size}")
        self.size = width, height
        return texture, level, layer


def check_owner(graph: Graph, resource: object) -> None:
    """Raise GraphError where a resource is neither persistent nor of this frame."""
    if isinstance(resource, (Texture, Buffer)):
        return
    if not isinstance(resource, (TextureHandle, BufferHandle)) or resource.graph is not graph:
        name = getattr(resource, "name", resource)
        raise GraphError(f"{name!r} is no resource of this frame")
