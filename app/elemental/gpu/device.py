"""The device: context, resources, programs, frames; the only maker of GL objects."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from elemental.core.paths import glsl_root
from elemental.gpu import gl as c
from elemental.gpu import screen
from elemental.gpu.execute import Executor
from elemental.gpu.formats import Format
from elemental.gpu.graph import Graph
from elemental.gpu.graph_report import GraphReport
from elemental.gpu.headless import adopt, create
from elemental.gpu.heap import keep_freed_memory
from elemental.gpu.info import DeviceInfo, check_limits
from elemental.gpu.library import ShaderLibrary
from elemental.gpu.messages import GlError, Messages
from elemental.gpu.params import ParamRing
from elemental.gpu.program import Program
from elemental.gpu.readback import ReadbackQueue
from elemental.gpu.resources import Buffer, Texture, VertexInput
from elemental.gpu.shaders import Raster, Shader
from elemental.gpu.shape import TextureDesc
from elemental.gpu.timers import PassTimers, PassTiming
from elemental.gpu.watch import ShaderWatcher

FRAMES_IN_FLIGHT = 3
"""Frames that the CPU may run ahead; without a bound a software driver's queue grows."""


class GpuMemoryError(MemoryError):
    """The driver, or the device's budget, has no memory for a resource."""


class Device:
    """A GL context with everything that is made in it."""

    def __init__(self, ctx: moderngl.Context, loader: c.Loader, debug: bool = False) -> None:
        self.ctx = ctx
        self._loader = loader
        self.gl = c.GL(loader, ctx.version_code)
        check_limits(self.gl)
        self.debug = debug
        self.names_passes = debug or _DEBUG_TOOL in ctx.extensions
        """Whether each pass is a debug group: where a debugger looks on."""
        self.log = Messages(self.gl)
        self.memory_budget: int | None = None
        """Bytes that may be allocated; None: as many as the driver gives."""
        self.info = DeviceInfo.of(ctx)
        if self.info.software:
            keep_freed_memory()
        self.storage_limit = self.gl.integer(c.MAX_SHADER_STORAGE_BLOCK_SIZE)
        self.texel_limit = self.gl.integer(c.MAX_TEXTURE_BUFFER_SIZE)
        self.largest_texture_px = self.gl.integer(c.MAX_TEXTURE_SIZE)
        """Longest side of a texture."""
        self.max_anisotropy = float(ctx.max_anisotropy)
        self.scratch_unit = self.gl.integer(c.MAX_COMBINED_TEXTURE_IMAGE_UNITS) - 1
        """Texture unit of uploads and allocations, beyond those of one stage: used by no pass."""
        self.shader_root: Path = glsl_root()
        self.frame = 0
        """Number of graphs executed."""
        self.wants_report = False
        self.graph_report: GraphReport | None = None
        """Of the newest frame that ``report_next_frame`` asked about."""
        self._bytes: Counter[str] = Counter()
        self._fences: deque[int] = deque()
        self._watcher: ShaderWatcher | None = None
        self._watched: set[Path] = set()
        self.library = ShaderLibrary(self)
        self.executor = Executor(self)
        self.params = ParamRing(self)
        self.readbacks = ReadbackQueue(self)
        self.timers = PassTimers(self.gl)
        self.gl.glEnable(c.TEXTURE_CUBE_MAP_SEAMLESS)
        self.gl.glDisable(c.DITHER)  # on at first: drivers may shift the codes of the G-buffer

    @classmethod
    def headless(cls, debug: bool = False) -> Device:
        """A device without a window: EGL, else OSMesa. Raises RuntimeError with both reasons."""
        return cls(*create(), debug=debug)

    @classmethod
    def from_window(cls, loader: Callable[[str], Any] | c.Loader, debug: bool = False) -> Device:
        """A device on the window's current context; ``loader`` may be glfw.get_proc_address."""
        return cls(*adopt(loader), debug=debug)

    # Resources ---------------------------------------------------------------------------------

    def buffer(
        self,
        name: str,
        contents: npt.NDArray[Any] | bytes | int,
        category: str = "other",
        dynamic: bool | None = None,
    ) -> Buffer:
        """A persistent buffer of ``contents``, or of so many undefined bytes.

        ``dynamic``: it is written again and again (by default, where no contents are given);
        drivers warn of such writes to a buffer that was made with static contents.
        """
        if isinstance(contents, (int, np.integer)):
            return Buffer(self, name, max(int(contents), 4), category, dynamic is not False)
        raw = contents if isinstance(contents, bytes) else np.ascontiguousarray(contents).tobytes()
        return Buffer(self, name, raw or bytes(4), category, bool(dynamic))

    def texture(
        self,
        name: str,
        size: tuple[int, ...],
        format: Format,
        *,
        mips: int = 1,
        layers: int | None = None,
        cube: bool = False,
        data: npt.NDArray[Any] | bytes | None = None,
        category: str = "textures",
    ) -> Texture:
        """A persistent texture: 2D, 3D by three extents, an array by ``layers``.

        ``data`` fills level 0, rows bottom up, and the other levels by box filter.
        """
        desc = TextureDesc(tuple(size), format, mips, layers, cube)
        texture = Texture(self, name, desc, category)
        if data is not None:
            try:
                texture.write(data)
            except ValueError:
                texture.release()
                raise
            if mips > 1:
                texture.generate_mips()
        return texture

    def vertex_input(
        self,
        content: Sequence[tuple[Buffer, str, Sequence[str]]],
        index: Buffer | None = None,
    ) -> VertexInput:
        """Vertex buffers, each with its moderngl format and attribute names; uint32 indices.

        ``"3f"`` holds three floats, ``"4f1"`` four normalized bytes, ``"1u/i"`` a uint an instance.
        """
        return VertexInput(self, content, index)

    def allocated(self, resource: Texture | Buffer, nbytes: int) -> None:
        """The one check for lack of memory; called by each resource once it is made."""
        if nbytes >= _CHECKED_BYTES or self.debug:
            error = self.gl.glGetError()
            if error == c.OUT_OF_MEMORY:
                self.log.drop_out_of_memory()
        else:
            error = 0
        self._bytes[resource.category] += nbytes
        over = self.memory_budget is not None and sum(self._bytes.values()) > self.memory_budget
        if error == c.OUT_OF_MEMORY or over:
            reason = "the driver is out of memory" if error else "the memory budget is spent"
            resource.release()
            raise GpuMemoryError(f"{resource!r} of {nbytes / 2**20:.1f} MiB: {reason}")
        if error:
            raise GlError(f"making {resource!r}: GL error 0x{error:X}")

    def released(self, resource: Texture | Buffer) -> None:
        """Undo ``allocated``."""
        self._bytes[resource.category] -= resource.nbytes
        if isinstance(resource, Texture):
            self.executor.framebuffers.forget(resource.serial)

    def bind_for_update(self, target: int, glo: int) -> None:
        """Bind a texture to the unit that no pass uses, for allocation, upload or read-back."""
        self.gl.glActiveTexture(c.TEXTURE0 + self.scratch_unit)
        self.gl.glBindTexture(target, glo)
        self.executor.binder.texture_unit_changed()

    def bytes(self) -> dict[str, int]:
        """Bytes allocated now, by category."""
        return {name: self._bytes[name] for name in sorted(self._bytes) if self._bytes[name]}

    # Programs ----------------------------------------------------------------------------------

    def program(self, shader: Shader) -> Program:
        """The compiled program. Raises ShaderError with ``file:line`` messages."""
        return self.library.get(shader)

    def watch_shaders(self) -> None:
        """From now on let a thread look out for edits, so that a frame without one asks no file."""
        if self._watcher is None:
            self._watcher = ShaderWatcher({self.shader_root, *self._watched})

    def watch_folder(self, folder: Path) -> None:
        """Have ``watch_shaders`` look into another folder, too, now or when it begins."""
        if folder in self._watched:
            return
        self._watched.add(folder)
        if self._watcher is not None:
            self.stop_watching_shaders()
            self.watch_shaders()

    def stop_watching_shaders(self) -> None:
        """End the thread of ``watch_shaders``."""
        if self._watcher is not None:
            self._watcher.release()
            self._watcher = None

    def reload_changed_shaders(self) -> list[str]:
        """Recompile what changed on disk; a failing edit keeps the last good program.

        Returns the compilers' messages of the failures. Cheap enough for every frame once
        ``watch_shaders`` was called.
        """
        if self._watcher is not None and not self._watcher.take():
            return []
        return self.library.reload_changed()

    def forget_vertex_input(self, serial: int) -> None:
        """Free the vertex arrays of a released vertex input."""
        self.library.forget_vertex_input(serial)

    # Frames ------------------------------------------------------------------------------------

    def begin_frame(self) -> Graph:
        """A new graph. Outputs kept by the last frame go back to the pool."""
        while len(self._fences) >= FRAMES_IN_FLIGHT:
            fence = self._fences.popleft()
            self.gl.glClientWaitSync(fence, 1, 10**10)
            self.gl.glDeleteSync(fence)
        self.executor.return_kept()
        self.executor.pool.end_frame()
        self.params.discard()
        self.timers.collect()
        self.readbacks.poll(self.frame)
        return Graph(self)

    def end_frame(self) -> None:
        """Called when a graph has run. Raises GlError on debug devices if the driver complained."""
        self._fences.append(self.gl.glFenceSync(c.SYNC_GPU_COMMANDS_COMPLETE, 0))
        self.gl.glFlush()
        self.frame += 1
        if self.debug:
            self.check()

    def report_next_frame(self) -> None:
        """Have the next graph that runs described in ``graph_report``."""
        self.wants_report = True

    def check(self) -> None:
        """Raise GlError if the driver reported an error or a high severity message."""
        self.log.check()

    def flush_reads(self) -> None:
        """Wait for the GPU and deliver every ``read_later``."""
        self.readbacks.poll(self.frame, wait=True)

    def finish(self) -> None:
        """Wait for the GPU; then every timing and every ``read_later`` has arrived."""
        self.gl.glFinish()
        self.timers.collect(wait=True)
        self.flush_reads()

    @property
    def messages(self) -> list[str]:
        """What the driver said so far, without notifications."""
        return [str(message) for message in self.log.messages]

    @property
    def timings(self) -> list[PassTiming]:
        """Passes of the newest finished frame."""
        return self.timers.timings

    @property
    def frame_ms(self) -> float:
        """GPU time of the newest finished frame."""
        return self.timers.frame_ms

    @property
    def frames_in_flight(self) -> int:
        """Frames handed to the driver that ``begin_frame`` has not yet seen finished."""
        return len(self._fences)

    def present(
        self,
        texture: Texture,
        area: screen.Area,
        through: tuple[Raster, str] | None = None,
        onto: Texture | None = None,
    ) -> None:
        """Put ``texture`` on ``area`` of the window's framebuffer and leave that bound.

        ``through``: a full-screen program and the name by which it samples the texture; without
        it the texels are copied. ``onto``: a texture that stands for the window.
        """
        if through is None:
            screen.copy(self, texture, area, onto)
        else:
            screen.draw(self, *through, texture, area, onto)

    def clear_screen(
        self, color: tuple[float, float, float] = (0.0, 0.0, 0.0), onto: Texture | None = None
    ) -> None:
        """Fill the window, or ``onto``, and leave it bound for draws outside of graphs."""
        screen.clear(self, onto, color)

    def release(self) -> None:
        """Free everything the device made for itself, then the context."""
        self.stop_watching_shaders()
        self.gl.glFinish()
        for part in (self.readbacks, self.executor, self.params, self.timers, self.library):
            part.release()
        while self._fences:
            self.gl.glDeleteSync(self._fences.popleft())
        self.log.release()
        self.ctx.release()


_DEBUG_TOOL = "GL_EXT_debug_tool"
"""Extension that RenderDoc and apitrace put before the driver's."""
_CHECKED_BYTES = 1 << 20
"""Smaller resources are checked for lack of memory on debug devices only."""
