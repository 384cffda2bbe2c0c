"""What a frame's graph was: passes in order, edges, targets and their memory, as plain values.

`Device.report_next_frame` asks for it; frames that nobody asks about pay nothing. [Mittring12
"Compositing Graph"]
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from elemental.gpu.passes import ComputePass, Copy, Pass, RasterPass, Readback
from elemental.gpu.pool import HeldTarget, PoolStats
from elemental.gpu.refs import AnyHandle, Resource
from elemental.gpu.resources import Texture
from elemental.gpu.timers import PassTiming

if TYPE_CHECKING:
    from elemental.gpu.device import Device
    from elemental.gpu.graph import Graph
    from elemental.gpu.plan import Schedule


@dataclass(frozen=True)
class GraphPass:
    """One pass that ran; ``reads`` and ``writes`` index the report's resources."""

    name: str
    kind: str
    """compute, raster, clear, copy or read back."""
    extent: tuple[int, ...]
    """Work groups of a dispatch (empty where the GPU counts them), pixels of a draw, else empty."""
    reads: tuple[int, ...]
    writes: tuple[int, ...]
    gpu_ms: float = 0.0
    cpu_ms: float = 0.0


@dataclass(frozen=True)
class GraphResource:
    """A texture or buffer of the frame."""

    name: str
    kind: str
    """texture or buffer."""
    size: tuple[int, ...]
    """(width, height[, depth]) of a texture, empty of a buffer."""
    format: str
    mips: int
    layers: int
    """Two-dimensional images at level 0."""
    nbytes: int
    transient: bool
    """Of the pool; else it outlives the frame."""
    kept: bool
    """An output of the frame."""
    first_pass: int
    last_pass: int
    """Where it is first and last used, in the order of the passes."""
    memory: int
    """Number of the physical resource: transients that share one have the same."""


@dataclass(frozen=True)
class GraphEdge:
    """A pass uses what an earlier one wrote; numbers of passes and of the resource."""

    producer: int
    consumer: int
    resource: int


@dataclass(frozen=True)
class PoolReport:
    """The pool of transient targets after the frame."""

    bytes: int
    high_water: int
    allocations: int
    reuses: int
    freed: int
    held: tuple[HeldTarget, ...]


@dataclass(frozen=True)
class GraphReport:
    """One frame. Passes stand in the order in which they ran; times are 0 until they are known."""

    frame: int
    passes: tuple[GraphPass, ...]
    culled: tuple[str, ...]
    """Passes that were declared and that nobody needed."""
    resources: tuple[GraphResource, ...]
    edges: tuple[GraphEdge, ...]
    pool: PoolReport

    def with_timings(self, timings: Sequence[PassTiming]) -> GraphReport:
        """With the times of a frame of the same passes, as of ``Device.timings``; else as it is."""
        if [timing.name for timing in timings] != [item.name for item in self.passes]:
            return self
        passes = tuple(
            GraphPass(p.name, p.kind, p.extent, p.reads, p.writes, t.gpu_ms, t.cpu_ms)
            for p, t in zip(self.passes, timings, strict=True)
        )
        return GraphReport(self.frame, passes, self.culled, self.resources, self.edges, self.pool)

    @property
    def transient_bytes(self) -> int:
        """Bytes that the frame's targets would take without sharing memory."""
        return sum(r.nbytes for r in self.resources if r.transient)

    @property
    def shared_bytes(self) -> int:
        """Bytes that they do take."""
        return sum({r.memory: r.nbytes for r in self.resources if r.transient}.values())


def describe(device: Device, graph: Graph, plan: Schedule) -> GraphReport:
    """The report of a graph whose passes just ran."""
    passes = [graph.passes[index] for index in plan.order]
    spans: dict[Resource, list[int]] = {}
    for position, node in enumerate(passes):
        for used in (node.reads, node.modifies, node.overwrites):
            for resource in used:
                spans.setdefault(resource, [position, position])[1] = position
    number = {resource: k for k, resource in enumerate(spans)}
    resources = tuple(
        _resource(resource, span, resource in graph.kept) for resource, span in spans.items()
    )
    return GraphReport(
        frame=device.frame,
        passes=tuple(_pass(node, number) for node in passes),
        culled=tuple(graph.passes[index].name for index in plan.culled),
        resources=resources,
        edges=_edges(passes, number),
        pool=pool_report(device),
    )


def pool_report(device: Device) -> PoolReport:
    """The pool as it is now."""
    pool = device.executor.pool
    stats: PoolStats = pool.stats
    return PoolReport(
        stats.bytes, stats.high_water, stats.allocations, stats.reuses, stats.freed,
        tuple(pool.held()),
    )  # fmt: skip


def _edges(passes: Sequence[Pass], number: dict[Resource, int]) -> tuple[GraphEdge, ...]:
    edges: dict[GraphEdge, None] = {}
    writer: dict[Resource, int] = {}
    for position, node in enumerate(passes):
        for used in (node.reads, node.modifies):
            for resource in used:
                if resource in writer and writer[resource] != position:
                    edges[GraphEdge(writer[resource], position, number[resource])] = None
        for written in (node.modifies, node.overwrites):
            for resource in written:
                writer[resource] = position
    return tuple(edges)


def _pass(node: Pass, number: dict[Resource, int]) -> GraphPass:
    kind = "clear"
    extent: tuple[int, ...] = ()
    if isinstance(node, ComputePass):
        kind, extent = "compute", () if node.indirect is not None else node.groups
    elif isinstance(node, RasterPass):
        kind, extent = "raster", node.uses.size
    elif isinstance(node, Copy):
        kind = "copy"
    elif isinstance(node, Readback):
        kind = "read back"
    writes = dict.fromkeys((*node.modifies, *node.overwrites))
    reads = dict.fromkeys(node.reads)
    return GraphPass(
        node.name, kind, extent, tuple(number[r] for r in reads), tuple(number[r] for r in writes)
    )


def _resource(resource: Resource, span: Sequence[int], kept: bool) -> GraphResource:
    transient = isinstance(resource, AnyHandle)
    physical: Any = resource.physical if isinstance(resource, AnyHandle) else resource
    first, last = span
    kind = "buffer"
    shape: tuple[tuple[int, ...], str, int, int] = (), "", 1, 1
    if isinstance(physical, Texture):
        desc = physical.desc
        kind, shape = "texture", (desc.size, desc.format.name, desc.mips, desc.slices)
    return GraphResource(
        resource.name, kind, *shape, physical.nbytes, transient, kept, first, last, physical.serial
    )
