"""A frame made ready to run: order, lifetimes, GL objects; kept for the frames that are alike."""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from elemental.gpu.binder import Binder
from elemental.gpu.passes import Pass
from elemental.gpu.plan import Schedule, schedule
from elemental.gpu.refs import AnyHandle, Resource
from elemental.gpu.resources import Buffer, Texture
from elemental.gpu.targets import Framebuffers
from elemental.gpu.uses import Attachment, Bound, Uses

if TYPE_CHECKING:
    from elemental.gpu.targets import Attached


class FramePlan:
    """What follows from the uses of a frame's passes and its outputs. Raises PlanError."""

    def __init__(self, passes: Sequence[Pass], kept: Sequence[Resource]) -> None:
        used = dict.fromkeys(
            resource
            for node in passes
            for resources in (node.reads, node.modifies, node.overwrites)
            for resource in resources
        )
        persistent = {item for item in (*used, *kept) if not isinstance(item, AnyHandle)}
        self.schedule: Schedule = schedule(passes, attrgetter("name"), persistent, kept)
        self.uses: list[Uses] = [passes[index].uses for index in self.schedule.order]
        """Of the passes that run, in that order."""
        self.lifetimes: list[tuple[AnyHandle, bool]] = []
        """Handles as they come to life (True) and go back to the pool."""
        for births, deaths in zip(self.schedule.births, self.schedule.deaths, strict=True):
            self.lifetimes += [(handle, True) for handle in births]
            self.lifetimes += [(handle, False) for handle in deaths]
        self.handles: list[AnyHandle] = [handle for handle, born in self.lifetimes if born]
        self.kept: list[AnyHandle] = [handle for handle in self.handles if handle in kept]
        self.passing: list[AnyHandle] = [handle for handle in self.handles if handle not in kept]
        """The handles, by whether they outlive the passes."""
        self.bound: list[Bound] = []
        """GL objects of each pass that runs, for the targets of the newest frame."""
        self.labels: list[tuple[Texture | Buffer, str]] = []
        """The targets, each named after all handles that it is."""
        self._targets: list[Texture | Buffer | None] = []

    def bind(self, binder: Binder, framebuffers: Framebuffers) -> None:
        """Find the GL objects of each pass, where the handles have other targets than before."""
        targets = [handle.physical for handle in self.handles]
        if targets == self._targets and self.bound:
            return
        self._targets = targets
        self.bound = [_bound(uses, binder, framebuffers) for uses in self.uses]
        names: dict[Any, list[str]] = {}
        for handle, target in zip(self.handles, targets, strict=True):
            names.setdefault(target, []).append(handle.name)
        self.labels = [(target, ", ".join(dict.fromkeys(own))) for target, own in names.items()]


def _bound(uses: Uses, binder: Binder, framebuffers: Framebuffers) -> Bound:
    """The GL objects of one pass: found anew where a handle has another target than before."""
    targets = [handle.physical for handle in uses.transients()]
    if uses.bound is not None and targets == uses.targets:
        return uses.bound
    color = [_attached(attachment) for attachment in uses.color]
    depth = None if uses.depth is None else _attached(uses.depth)
    uses.targets = targets
    uses.bound = Bound(
        [(_physical(resource), bit, write) for resource, bit, write in uses.accesses],
        binder.prepare([(look, _physical(resource)) for look, resource in uses.bindings]),
        color,
        depth,
        framebuffers.get(color, depth, uses.size) if uses.renders else 0,
    )
    return uses.bound


def _physical(resource: Resource) -> Any:
    return resource.physical if isinstance(resource, AnyHandle) else resource


def _attached(attachment: Attachment) -> Attached:
    texture, level, layer = attachment
    return _physical(texture), level, layer
