"""Running a planned frame: targets from the pool, barriers, bindings, draws and dispatches."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Hashable, Sequence
from typing import TYPE_CHECKING, Any

from elemental.gpu import gl as c
from elemental.gpu import state as raster_state
from elemental.gpu.binder import Binder
from elemental.gpu.binding import GraphError
from elemental.gpu.encode import Encoder
from elemental.gpu.frame_plan import FramePlan
from elemental.gpu.graph_report import describe
from elemental.gpu.passes import (
    ClearBuffer,
    ClearTexture,
    ComputePass,
    Copy,
    RasterPass,
    Readback,
)
from elemental.gpu.plan import Hazards
from elemental.gpu.pool import TargetPool
from elemental.gpu.recall import Recall
from elemental.gpu.refs import AnyHandle
from elemental.gpu.resources import Buffer, Texture
from elemental.gpu.shape import TextureDesc
from elemental.gpu.targets import Framebuffers

if TYPE_CHECKING:
    from elemental.gpu.device import Device
    from elemental.gpu.graph import Graph


class Executor:
    """Runs graphs; owns the pool, what frames share, hazards, samplers and framebuffers."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.gl = device.gl
        self.hazards = Hazards()
        self.binder = Binder(device.gl, device.max_anisotropy)
        self.framebuffers = Framebuffers(device.gl)
        self.pool: TargetPool[Texture | Buffer] = TargetPool(self._make)
        self.recall = Recall()
        self._kept: Sequence[AnyHandle] = ()
        self._encoded: dict[str, bytes] = {}
        self._state: raster_state.RasterState | None = None
        self._params = (0, 0)
        self._run = {
            ComputePass: self._compute,
            RasterPass: self._raster,
            ClearTexture: self._clear_texture,
            ClearBuffer: self._clear_buffer,
            Copy: self._copy,
            Readback: self._readback,
        }

    def _make(self, description: Hashable) -> Texture | Buffer:
        if isinstance(description, TextureDesc):
            return Texture(self.device, "target", description, "targets")
        assert isinstance(description, int)
        return Buffer(self.device, "scratch", description, "targets")

    # Frames ------------------------------------------------------------------------------------

    def return_kept(self) -> None:
        """Give the outputs of the last frame back to the pool."""
        for handle in self._kept:
            self._give_back(handle)
        self._kept = ()

    def run(self, graph: Graph) -> None:
        """Plan and run one frame."""
        device, gl = self.device, self.gl
        plan = self._plan(graph)
        self._assign(plan)
        passes = [graph.passes[index] for index in plan.schedule.order]
        queries: list[int] = []
        cpu_ms: list[float] = []
        try:
            plan.bind(self.binder, self.framebuffers)
            self._label(plan)
            self.binder.forget()
            self._state = None
            self._params = device.params.upload()
            gl.glDisable(c.SCISSOR_TEST)
            queries = device.timers.begin(len(passes))
            named = device.names_passes
            started = time.perf_counter()
            for node, bound, query in zip(passes, plan.bound, queries[:-1], strict=True):
                if named:
                    self._push(node.name)
                gl.glQueryCounter(query, c.TIMESTAMP)
                try:
                    node.bound = bound
                    self.barrier(bound.accesses)
                    self._run[type(node)](node)
                finally:
                    if named:
                        gl.glPopDebugGroup()
                now = time.perf_counter()
                cpu_ms.append((now - started) * 1e3)
                started = now
            gl.glQueryCounter(queries[-1], c.TIMESTAMP)
            if device.wants_report:
                device.wants_report = False
                device.graph_report = describe(device, graph, plan.schedule)
        except BaseException:
            for handle in plan.kept:
                self._give_back(handle)
            device.timers.discard(queries)
            raise
        finally:
            for handle in plan.passing:
                handle.physical = None
        self._kept = plan.kept
        assert self.pool.stats.in_use == len(self._kept), "a target was not given back"
        device.timers.end([node.name for node in passes], cpu_ms, queries)
        device.end_frame()

    def _plan(self, graph: Graph) -> FramePlan:
        """The plan of a frame: that of an earlier one, where the same is used for the same."""
        key = (*[node.uses for node in graph.passes], None, *graph.kept)
        plan = self.recall.plans.get(key)
        if plan is None:
            plan = self.recall.plans[key] = FramePlan(graph.passes, graph.kept)
        for handle in plan.handles:
            if handle.graph is not graph:
                raise GraphError(f"{handle.name!r} is no resource of this frame")
        return plan

    def _assign(self, plan: FramePlan) -> None:
        """Give each handle its target: those that never live at one time may have the same."""
        pool = self.pool
        held: dict[AnyHandle, Any] = {}
        try:
            for handle, born in plan.lifetimes:
                if born:
                    handle.physical = held[handle] = pool.acquire(handle.description)
                else:
                    pool.give_back(handle.description, held.pop(handle))
        except BaseException:
            for handle in held:
                self._give_back(handle)
            for handle in plan.handles:
                handle.physical = None
            raise

    def _give_back(self, handle: AnyHandle) -> None:
        target, handle.physical = handle.physical, None
        assert target is not None
        self.pool.give_back(handle.description, target)

    def _label(self, plan: FramePlan) -> None:
        """Name the targets for debuggers and driver messages."""
        for target, name in plan.labels:
            if target.name != name:
                target.name = name
                kind = c.LABEL_TEXTURE if isinstance(target, Texture) else c.LABEL_BUFFER
                self.gl.label(kind, target.glo, name)

    def _push(self, name: str) -> None:
        encoded = self._encoded.get(name)
        if encoded is None:
            encoded = self._encoded[name] = name.encode()[:200]
        self.gl.glPushDebugGroup(c.DEBUG_SOURCE_APPLICATION, 0, len(encoded), encoded)

    def barrier(self, accesses: Sequence[tuple[Any, int, int]]) -> None:
        """Issue what the accesses that follow need."""
        bits = self.hazards.barrier_before(accesses)
        if bits:
            self.gl.glMemoryBarrier(bits)

    def _bind_pass(self, node: Any) -> None:
        self.binder.bind(node.bound.bindings)
        self.binder.bind_params(node.params, *self._params)

    # Kinds of passes ---------------------------------------------------------------------------

    def _compute(self, node: Any) -> None:
        self._bind_pass(node)
        compute = node.uses.program.mgl
        if node.indirect is not None:
            source, _, _ = node.bound.accesses[-1]
            compute.run_indirect(source.mgl, node.indirect)
        elif 0 not in node.groups:
            compute.run(*node.groups)

    def _raster(self, node: Any) -> None:
        gl = self.gl
        gl.glBindFramebuffer(c.FRAMEBUFFER, node.bound.framebuffer)
        self._clear_targets(node)
        gl.glViewport(*node.viewport)
        self.set_state(node.state)
        self._bind_pass(node)
        encoder = Encoder(self, node)
        if node.draw is None:
            encoder.draw(None, node.vertices, instances=node.instances)
        else:
            node.draw(encoder)

    def set_state(self, state: raster_state.RasterState) -> None:
        """Apply a raster state unless it is the present one."""
        if state is not self._state:
            raster_state.apply(self.gl, state, self._state)
            self._state = state

    def _clear_targets(self, node: Any) -> None:
        if node.clear_depth is None and node.clear_stencil is None and not node.clears:
            return
        gl = self.gl
        raster_state.prepare_clear(gl)
        self._state = None
        if node.tile is not None:
            gl.glEnable(c.SCISSOR_TEST)
            gl.glScissor(*node.tile)
        for number, clear in enumerate(node.clears):
            if clear is not None:
                self._clear_color(number, clear, node.bound.color[number][0].format.kind)
        if node.clear_depth is not None:
            value = ctypes.c_float(node.clear_depth)
            gl.glClearBufferfv(c.DEPTH, 0, ctypes.byref(value))
        depth = node.bound.depth
        if depth is not None and depth[0].format.kind == "depth_stencil":
            stencil = node.clear_stencil
            if stencil is None and node.clear_depth is not None:
                stencil = 0
            if stencil is not None:
                gl.glClearBufferiv(c.STENCIL, 0, ctypes.byref(ctypes.c_int(stencil)))
        if node.tile is not None:
            gl.glDisable(c.SCISSOR_TEST)

    def _clear_color(self, number: int, color: Sequence[float], kind: str) -> None:
        if kind == "uint":
            integers = (ctypes.c_uint * 4)(*[int(value) for value in color])
            self.gl.glClearBufferuiv(c.COLOR, number, integers)
        else:
            self.gl.glClearBufferfv(c.COLOR, number, (ctypes.c_float * 4)(*color))

    def _clear_texture(self, node: Any) -> None:
        texture, _, _ = node.bound.accesses[0]
        color = (*node.color, 0, 0, 0, 0)[:4]
        kind = texture.format.kind
        if self.gl.has_clear_tex_image and not texture.format.is_depth:
            transfer = (0x8D99, 0x1405) if kind == "uint" else (0x1908, 0x1406)
            element = ctypes.c_uint if kind == "uint" else ctypes.c_float
            value = (element * 4)(*[int(v) if kind == "uint" else v for v in color])
            for level in range(texture.mips):
                self.gl.glClearTexImage(texture.glo, level, *transfer, value)
            return
        raster_state.prepare_clear(self.gl)
        self._state = None
        for level in range(texture.mips):
            attached = (texture, level, -1)
            depth = attached if texture.format.is_depth else None
            targets = [] if depth else [attached]
            framebuffer = self.framebuffers.get(targets, depth, (0, 0))
            self.gl.glBindFramebuffer(c.FRAMEBUFFER, framebuffer)
            if kind == "depth_stencil":
                self.gl.glClearBufferfi(c.DEPTH_STENCIL, 0, color[0], int(color[1]))
            elif depth:
                self.gl.glClearBufferfv(c.DEPTH, 0, (ctypes.c_float * 1)(color[0]))
            else:
                self._clear_color(0, color, kind)

    def _clear_buffer(self, node: Any) -> None:
        gl = self.gl
        buffer, _, _ = node.bound.accesses[0]
        gl.glBindBuffer(c.COPY_WRITE_BUFFER, buffer.glo)
        words = (ctypes.c_uint * len(node.words))(*node.words)
        one = len(words) == 1
        format, kind = (c.R32UI, c.RED_INTEGER) if one else (c.RGBA32UI, c.RGBA_INTEGER)
        span = (node.offset, node.length)
        gl.glClearBufferSubData(c.COPY_WRITE_BUFFER, format, *span, kind, c.UNSIGNED_INT, words)

    def _copy(self, node: Any) -> None:
        gl = self.gl
        (source, _, _), (target, _, _) = node.bound.accesses
        if node.span is None:
            for level in range(source.mips):
                width, height, slices = source.extent(level)
                first, count = (0, slices) if node.layer is None else (node.layer, 1)
                x, y, width, height = node.tile or (0, 0, width, height)
                ends = (source.glo, source.target, level, x, y, first)
                to = (target.glo, target.target, level, x, y, first)
                gl.glCopyImageSubData(*ends, *to, width, height, count)
            return
        gl.glBindBuffer(c.COPY_READ_BUFFER, source.glo)
        gl.glBindBuffer(c.COPY_WRITE_BUFFER, target.glo)
        gl.glCopyBufferSubData(c.COPY_READ_BUFFER, c.COPY_WRITE_BUFFER, *node.span)

    def _readback(self, node: Any) -> None:
        source, _, _ = node.bound.accesses[0]
        self.device.readbacks.request(source, node.callback, self.device.frame)

    def release(self) -> None:
        """Free the pool, the samplers and the framebuffers."""
        self.return_kept()
        self.recall.clear()
        self.pool.clear()
        self.framebuffers.release()
        self.binder.release()
