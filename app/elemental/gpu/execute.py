"""Running a planned frame: targets from the pool, barriers, bindings, draws and dispatches."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Hashable, Sequence
from typing import TYPE_CHECKING, Any

from elemental.gpu import gl as c
from elemental.gpu import state as raster_state
from elemental.gpu.binder import Binder
from elemental.gpu.encode import Encoder
from elemental.gpu.graph_report import describe
from elemental.gpu.passes import (
    ClearBuffer,
    ClearTexture,
    ComputePass,
    Copy,
    Pass,
    RasterPass,
    Readback,
)
from elemental.gpu.plan import Hazards, schedule
from elemental.gpu.pool import TargetPool
from elemental.gpu.refs import BufferHandle, TextureHandle
from elemental.gpu.resources import Buffer, Texture
from elemental.gpu.shape import TextureDesc
from elemental.gpu.targets import Framebuffers

if TYPE_CHECKING:
    from elemental.gpu.device import Device
    from elemental.gpu.graph import Graph


class Executor:
    """Runs graphs; owns the pool, the hazards, samplers and framebuffers of a device."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.gl = device.gl
        self.hazards = Hazards()
        self.binder = Binder(device.gl, device.max_anisotropy)
        self.framebuffers = Framebuffers(device.gl)
        self.pool: TargetPool[Texture | Buffer] = TargetPool(self._make)
        self._kept: list[tuple[Hashable, Texture | Buffer, TextureHandle | BufferHandle]] = []
        self._encoded: dict[str, bytes] = {}
        self._physical: list[Any] = []
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
        for description, physical, handle in self._kept:
            handle.physical = None
            self.pool.give_back(description, physical)
        self._kept.clear()

    def run(self, graph: Graph) -> None:
        """Plan and run one frame."""
        device, gl = self.device, self.gl
        passes, resources = graph.passes, graph.resources
        names = [resource.name for resource in resources]
        plan = schedule(passes, names, graph.persistent, graph.kept)
        physical: list[Any] = list(resources)
        self._physical = physical
        held: set[int] = set()
        self.binder.forget()
        self._state = None
        self._params = device.params.upload()
        gl.glDisable(c.SCISSOR_TEST)
        queries = device.timers.begin(len(plan.order))
        cpu_ms: list[float] = []
        ran: list[str] = []
        started = time.perf_counter()
        try:
            for position, index in enumerate(plan.order):
                for born in plan.births[position]:
                    physical[born] = self._acquire(resources[born])
                    held.add(born)
                node = passes[index]
                self._push(node.name)
                gl.glQueryCounter(queries[position], c.TIMESTAMP)
                self.barrier([(physical[r], bit, write) for r, bit, write in node.accesses])
                self._run[type(node)](node)
                gl.glPopDebugGroup()
                for dead in plan.deaths[position]:
                    held.discard(dead)
                    self._give_back(resources[dead], physical[dead])
                ran.append(node.name)
                now = time.perf_counter()
                cpu_ms.append((now - started) * 1e3)
                started = now
        except BaseException:
            if len(ran) < len(plan.order):
                gl.glPopDebugGroup()
            for index in held:
                self._give_back(resources[index], physical[index])
            device.timers.discard(queries)
            raise
        gl.glQueryCounter(queries[-1], c.TIMESTAMP)
        for index in held:
            handle = resources[index]
            assert isinstance(handle, (TextureHandle, BufferHandle))
            self._kept.append((_description(handle), physical[index], handle))
        assert self.pool.stats.in_use == len(self._kept), "a target was not given back"
        if device.wants_report:
            device.wants_report = False
            device.graph_report = describe(device, graph, plan, physical)
        device.timers.end(ran, cpu_ms, queries)
        device.end_frame()

    def _acquire(self, handle: Any) -> Texture | Buffer:
        resource = self.pool.acquire(_description(handle))
        if resource.name != handle.name:
            resource.name = handle.name
            kind = c.LABEL_TEXTURE if isinstance(resource, Texture) else c.LABEL_BUFFER
            self.gl.label(kind, resource.glo, handle.name)
        handle.physical = resource
        return resource

    def _give_back(self, handle: Any, physical: Texture | Buffer) -> None:
        handle.physical = None
        self.pool.give_back(_description(handle), physical)

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

    def _bind_pass(self, node: Pass) -> None:
        binder = self.binder
        binder.bind(node.bindings, self._physical)
        glo, base = self._params
        for unit, offset, size in node.params:
            binder.bind_params(unit, glo, base + offset, size)

    # Kinds of passes ---------------------------------------------------------------------------

    def _compute(self, node: Any) -> None:
        self._bind_pass(node)
        compute = node.program.mgl
        if node.indirect is not None:
            resource, offset = node.indirect
            compute.run_indirect(self._physical[resource].mgl, offset)
        elif 0 not in node.groups:
            compute.run(*node.groups)

    def _raster(self, node: Any) -> None:
        physical, gl = self._physical, self.gl
        color = [(physical[r], level, layer) for r, level, layer, _ in node.color]
        depth = None
        if node.depth is not None:
            depth = (physical[node.depth[0]], *node.depth[1:])
        framebuffer = self.framebuffers.get(color, depth, node.size)
        gl.glBindFramebuffer(c.FRAMEBUFFER, framebuffer)
        self._clear_targets(node, color, depth)
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
            self._state = state
            raster_state.apply(self.gl, state)

    def _clear_targets(self, node: RasterPass, color: Sequence[Any], depth: Any) -> None:
        clears = [item[3] for item in node.color]
        if (
            node.clear_depth is None
            and node.clear_stencil is None
            and not any(clear is not None for clear in clears)
        ):
            return
        gl = self.gl
        raster_state.prepare_clear(gl)
        self._state = None
        if node.tile is not None:
            gl.glEnable(c.SCISSOR_TEST)
            gl.glScissor(*node.tile)
        for number, clear in enumerate(clears):
            if clear is not None:
                self._clear_color(number, clear, color[number][0].format.kind)
        if node.clear_depth is not None:
            value = ctypes.c_float(node.clear_depth)
            gl.glClearBufferfv(c.DEPTH, 0, ctypes.byref(value))
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
        texture: Texture = self._physical[node.resource]
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
        gl.glBindBuffer(c.COPY_WRITE_BUFFER, self._physical[node.resource].glo)
        value = ctypes.byref(ctypes.c_uint(node.value))
        span = (node.offset, node.length)
        kind = (c.RED_INTEGER, c.UNSIGNED_INT)
        gl.glClearBufferSubData(c.COPY_WRITE_BUFFER, c.R32UI, *span, *kind, value)

    def _copy(self, node: Any) -> None:
        gl = self.gl
        source, target = self._physical[node.source], self._physical[node.target]
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
        source = self._physical[node.resource]
        self.device.readbacks.request(source, node.callback, self.device.frame)

    def release(self) -> None:
        """Free the pool, the samplers and the framebuffers."""
        self.return_kept()
        self.pool.clear()
        self.framebuffers.release()
        self.binder.release()


def _description(handle: Any) -> Hashable:
    return handle.desc if isinstance(handle, TextureHandle) else handle.nbytes
