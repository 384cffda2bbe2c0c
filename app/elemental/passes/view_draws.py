"""What a camera can see of the scene's solid instances, found out on the GPU."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from elemental.core.layout import Block, layouts, pack, pack_array
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.depth_pyramid import depth_pyramid
from elemental.passes.instance_table import InstanceTable
from elemental.passes.placed import Placed
from elemental.passes.scene_pack import Array

CAMERA = "camera"
"""The viewer of all that the camera sees."""
OCCLUDERS = "camera.occluders"
"""The viewer of what is drawn first, for its depth alone: it may hide others."""
SEEN_BEFORE, SEEN_NOW, IN_FRUSTUM = (
    Compute("cull/instances.comp.glsl", defines={"STAGE": stage}) for stage in range(3)
)
OCCLUSION_FROM = 20_000
"""Triangles of a scene from which it pays to find out what others hide [measured]."""
SETTLED = 2
"""Frames of one view after which the draws are what they will be: the first knows what was seen of
another view, the second what is seen of this one."""
CULLING = ("none", "frustum", "occlusion")
"""What is left out: nothing, what is outside the view, what others hide too."""


class CullCounters:
    """What became of the instances, as the GPU counted them frames ago: the struct CullCounts."""

    def __init__(self) -> None:
        self._counts = np.zeros(1, layouts().struct("CullCounts"))[0]

    def receive(self, raw: bytes) -> None:
        """Take the counts of a frame."""
        self._counts = np.frombuffer(raw, self._counts.dtype, count=1)[0]

    def counters(self) -> dict[str, int]:
        """By the names of the report."""
        counts = self._counts
        return {
            "instances_drawn": int(counts["drawn"]),
            "instances_outside": int(counts["outside"]),
            "instances_hidden": int(counts["hidden"]),
            "triangles_drawn": int(counts["triangles_drawn"]),
        }


class ViewDraws:
    """Draw commands of the instances that the camera sees.

    `visible` holds them. A frame that `hides` draws `occluders` first, of what the frame before
    saw: their depth tells what others hide. Nothing is read back. Frames of one view and one scene
    go on with the commands that they have, once graphs that wrote these have run.

    From `everything` that could be drawn, of which `solid` (D,) DRAW_COMMAND come first.
    """

    def __init__(
        self,
        device: Device,
        table: InstanceTable,
        everything: Placed,
        solid: Array,
        place: Callable[[str], Placed],
    ) -> None:
        self._everything, self._table, self._commands = everything, table, len(solid)
        self._visible, self.occluders = place(CAMERA), place(OCCLUDERS)
        self._extent = pack(layouts().block("Culling"), command_count=len(solid))
        self.counters = CullCounters()
        order = everything.order.nbytes
        self._seen = device.buffer("scene.seen", np.zeros(order // 4, "<u4"), category="meshes")
        self._boxes = device.buffer("scene.boxes", _boxes(table), category="meshes", dynamic=True)
        corners = solid["count"].astype(np.int64) @ solid["instance_count"]
        self._occlusion_pays = int(corners) >= 3 * OCCLUSION_FROM
        self._key: tuple[object, ...] = ()
        self._frames = 0
        self._last: Graph | None = None
        self._culls = self.hides = False

    @property
    def visible(self) -> Placed:
        """What the camera sees."""
        return self._visible if self._culls else self._everything

    def moved(self, rows: range) -> None:
        """Take over the boxes of instances that changed."""
        if rows:
            boxes = _boxes(self._table, slice(rows.start, rows.stop))
            self._boxes.write(boxes, rows.start * boxes.itemsize)

    def begin(
        self, g: Graph, view: Block, size: tuple[int, int], version: int, culling: str
    ) -> None:
        """Find out what is in the frustum of a frame, or of that what was seen in the last one.

        view: the block View; version: differs where the scene does; culling: one of CULLING.
        """
        if culling == "occlusion" and not self._occlusion_pays:
            culling = "frustum"
        key = (np.asarray(view["clip_from_world"]).tobytes(), size, version, culling)
        stands = key == self._key and self._last is not None and self._last.has_run
        self._frames = self._frames + 1 if stands else 0
        self._key, self._last = key, g
        rests = self._frames >= SETTLED
        if self._culls and culling == "none":
            self.counters = CullCounters()  # counts that are still under way reach those of before
        self._culls, self.hides = culling != "none", culling == "occlusion" and not rests
        if self.hides:
            self._cull(g, SEEN_BEFORE, view, self.occluders, {"Seen": self._seen})
        elif self._culls and not rests:
            self._cull_and_count(g, IN_FRUSTUM, view, {})

    def finish(self, g: Graph, view: Block, depth: TextureHandle) -> None:
        """Find out what is seen, once `occluders` are drawn into the depth buffer, (W, H) px."""
        reads: dict[str, Ref] = {"u_depth_pyramid": depth_pyramid(g, depth)}
        self._cull_and_count(g, SEEN_NOW, view, {"Seen": self._seen}, reads)

    def _cull_and_count(
        self,
        g: Graph,
        shader: Compute,
        view: Block,
        writes: Mapping[str, Ref],
        reads: Mapping[str, Ref] = MappingProxyType({}),
    ) -> None:
        counts = g.buffer("scene.cull_counts", layouts().struct("CullCounts").itemsize)
        g.clear_buffer(counts)
        self._cull(g, shader, view, self._visible, {**writes, "Counts": counts}, reads)
        g.read_later(counts, self.counters.receive)

    def _cull(
        self,
        g: Graph,
        shader: Compute,
        view: Block,
        into: Placed,
        writes: Mapping[str, Ref],
        reads: Mapping[str, Ref] = MappingProxyType({}),
    ) -> None:
        g.compute(
            shader,
            reads={
                "Everything": self._everything.commands,
                "Order": self._everything.order,
                "Boxes": self._boxes,
                **reads,
            },
            writes={"Commands": into.commands, "Drawn": into.order, **writes},
            params={"View": view, "Culling": self._extent},
            threads=self._commands * int(layouts().constant("CULL_GROUP")),
        )

    def release(self) -> None:
        """Free everything but `everything`."""
        for placed in (self._visible, self.occluders):
            placed.release()
        for buffer in (self._seen, self._boxes):
            buffer.release()


def _boxes(table: InstanceTable, rows: slice = slice(None)) -> Array:
    """(N,) of the struct InstanceBox."""
    low, high, visible = table.low[rows], table.high[rows], table.visible[rows]
    struct = layouts().struct("InstanceBox")
    return pack_array(struct, len(low), low=low, visible=visible.astype(np.float32), high=high)
