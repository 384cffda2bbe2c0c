"""The frame graph: passes by handles and GLSL names; it finds order, lifetimes and barriers.

[Mittring12 "Compositing Graph"]: "created each frame; dependencies define execution order; RT on
demand, ref. counting, lazy release".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import repeat
from typing import TYPE_CHECKING, Any

from elemental.gpu import gl as c
from elemental.gpu.arguments import Color, clear_list, group_counts, triple
from elemental.gpu.binding import GraphError, Params, check_block_size, require_all
from elemental.gpu.formats import Format
from elemental.gpu.passes import (
    ClearBuffer,
    ClearTexture,
    ComputePass,
    Copy,
    Pass,
    Placed,
    RasterPass,
    Readback,
)
from elemental.gpu.refs import (
    AnyBuffer,
    AnyHandle,
    AnyTexture,
    BufferHandle,
    ImageRef,
    Layer,
    Mip,
    Ref,
    Resource,
    TextureHandle,
)
from elemental.gpu.resources import Texture
from elemental.gpu.shaders import Compute, Raster
from elemental.gpu.shape import TextureDesc
from elemental.gpu.state import DEFAULT, RasterState
from elemental.gpu.uses import Uses, check_owner

if TYPE_CHECKING:
    from elemental.gpu.device import Device
    from elemental.gpu.encode import Encoder

_NONE: Mapping[str, Any] = {}


class Graph:
    """One frame. Declare passes, ``keep`` the outputs, ``execute``; made by ``begin_frame``."""

    __slots__ = ("_executed", "_recall", "device", "handles", "has_run", "kept", "passes")

    def __init__(self, device: Device) -> None:
        self.device = device
        self._recall = device.executor.recall
        self._recall.begin_frame()
        self.passes: list[Pass] = []
        self.handles: list[AnyHandle] = []
        """Transient textures and buffers, as declared."""
        self.kept: list[Resource] = []
        """The frame's outputs."""
        self._executed = False
        self.has_run = False
        """Whether the frame was executed to its end."""

    # Resources ---------------------------------------------------------------------------------

    def texture(
        self,
        name: str,
        size: tuple[int, ...] | None = None,
        format: Format | None = None,
        *,
        like: AnyTexture | None = None,
        mips: int | None = None,
        layers: int | None = None,
        cube: bool = False,
    ) -> TextureHandle:
        """A transient texture; what is not given is taken from ``like`` (mips: 1)."""
        if like is not None:
            size = size or like.desc.size
            format = format or like.desc.format
        if size is None or format is None:
            raise GraphError(f"texture {name} needs a size and a format, or a texture to be like")
        handle = self._recall.handle(_texture, name, size, format, mips or 1, layers, cube)
        handle.graph = self
        self.handles.append(handle)
        return handle

    def buffer(self, name: str, nbytes: int) -> BufferHandle:
        """A transient buffer of ``nbytes``."""
        handle = self._recall.handle(BufferHandle, name, nbytes)
        handle.graph = self
        self.handles.append(handle)
        return handle

    def keep(self, resource: Resource) -> None:
        """Make ``resource`` an output: valid until the device's next ``begin_frame``."""
        check_owner(self, resource)
        if resource not in self.kept:
            self.kept.append(resource)

    def resources(self) -> list[Resource]:
        """Everything that the passes so far use or may use: handles first, as declared."""
        used: dict[Resource, None] = dict.fromkeys((*self.handles, *self.kept))
        for node in self.passes:
            for resources in (node.reads, node.modifies, node.overwrites):
                used.update(dict.fromkeys(resources))
        return list(used)

    # Passes ------------------------------------------------------------------------------------

    def compute(
        self,
        shader: Compute,
        name: str | None = None,
        *,
        reads: Mapping[str, Ref] | None = None,
        writes: Mapping[str, Ref] | None = None,
        params: Params | None = None,
        threads: int | Sequence[int] | None = None,
        groups: int | Sequence[int] | None = None,
        indirect: tuple[AnyBuffer, int] | None = None,
    ) -> None:
        """A dispatch over ``threads`` (rounded up to whole groups), ``groups``, or from a buffer.

        One dimension of more than 65,535 groups is folded into two; the shader must then take its
        index from ``linear_thread_id()`` of lib/dispatch.glsl. Raises GraphError.
        """
        reads, writes, params = reads or _NONE, writes or _NONE, params or _NONE
        key = (
            shader, indirect,
            *reads, *reads.values(), None, *writes, *writes.values(), None, *params,
        )  # fmt: skip
        uses = self._recall.uses.get(key)
        if uses is None:
            uses = Uses(self.device.program(shader))
            uses.use(self, reads, writes, params)
            require_all(uses.program, uses.missing)
            if indirect is not None:
                uses.read_buffers(self, indirect[:1])
                uses.accesses.append((indirect[0], c.COMMAND_BARRIER, 0))
            self._recall.uses[key] = uses
        node = ComputePass(name or shader.name, uses, self._place(uses, params))
        if (threads is not None) + (groups is not None) + (indirect is not None) != 1:
            raise GraphError(f"{node.name}: give one of threads, groups and indirect")
        if threads is not None:
            if threads != uses.threads:
                size = uses.program.local_size
                counts = group_counts(triple(threads), size, uses.program, node.name)
                uses.threads, uses.groups = threads, counts
            node.groups = uses.groups
        elif groups is not None:
            node.groups = group_counts(triple(groups), (1, 1, 1), uses.program, node.name)
        elif indirect is not None:
            node.indirect = indirect[1]
        self.passes.append(node)

    def raster(
        self,
        shader: Raster,
        name: str | None = None,
        *,
        color: Sequence[ImageRef] | ImageRef = (),
        depth: ImageRef | None = None,
        reads: Mapping[str, Ref] | None = None,
        writes: Mapping[str, Ref] | None = None,
        params: Params | None = None,
        state: RasterState = DEFAULT,
        clear_color: Color | Sequence[Color | None] | None = None,
        clear_depth: float | None = None,
        clear_stencil: int | None = None,
        viewport: tuple[int, int, int, int] | None = None,
        tile: tuple[int, int, int, int] | None = None,
        size: tuple[int, int] | None = None,
        draw: Callable[[Encoder], None] | None = None,
        vertices: int = 3,
        instances: int = 1,
        uses: Sequence[AnyBuffer] = (),
    ) -> None:
        """A draw into targets of one size, or into none (``size`` given).

        ``tile``: a viewport (x, y, width, height) that clears keep to, too, where ``viewport`` lets
        them fill the targets. ``vertices=3`` is a full-screen triangle from gl_VertexID. ``draw``
        issues draws itself; transient buffers that it draws from are listed in ``uses``. Raises
        GraphError.
        """
        reads, writes, params = reads or _NONE, writes or _NONE, params or _NONE
        single = isinstance(color, (Texture, TextureHandle, Mip, Layer))
        targets: Sequence[ImageRef] = (color,) if single else color  # type: ignore[assignment]
        name = name or shader.name
        clears = () if clear_color is None else clear_list(clear_color, len(targets), name)
        cleared = () if tile is not None else tuple([item is not None for item in clears])
        clears_depth = clear_depth is not None and tile is None
        writes_depth = depth is not None and (
            (state.depth_write and state.depth_test != "none")
            or clear_stencil is not None
            or clear_depth is not None
            or (state.stencil is not None and state.stencil.writes)
        )
        key = (
            shader, size, *targets, None, depth, cleared, clears_depth, writes_depth, *uses,
            *reads, *reads.values(), None, *writes, *writes.values(), None, *params,
        )  # fmt: skip
        used = self._recall.uses.get(key)
        if used is None:
            used = Uses(self.device.program(shader))
            used.renders = True
            used.size = size or (0, 0)
            used.use(self, reads, writes, params)
            for target, is_cleared in zip(targets, cleared or repeat(False), strict=False):
                used.color.append(used.attach(self, name, target, cleared=is_cleared))
            if depth is not None:
                used.depth = used.attach(
                    self, name, depth, cleared=clears_depth, written=writes_depth
                )
            if used.size == (0, 0):
                raise GraphError(f"{name}: a pass without targets needs size=")
            used.read_buffers(self, uses)
            self._recall.uses[key] = used
        if draw is None and used.missing:
            require_all(used.program, used.missing)
        node = RasterPass(name, used, self._place(used, params), state)
        node.clears, node.clear_depth, node.clear_stencil = clears, clear_depth, clear_stencil
        node.draw, node.vertices, node.instances = draw, vertices, instances
        node.viewport, node.tile = tile or viewport or (0, 0, *used.size), tile
        self.passes.append(node)

    def clear_texture(self, handle: AnyTexture, color: Sequence[float] = (0, 0, 0, 0)) -> None:
        """Fill every level and layer."""
        by_image = self.device.gl.has_clear_tex_image
        bit = c.TEXTURE_UPDATE_BARRIER if by_image else c.FRAMEBUFFER_BARRIER
        uses = self._transfer(ClearTexture, bit, target=handle)
        self.passes.append(ClearTexture(f"clear {handle.name}", uses, tuple(color)))

    def clear_buffer(
        self,
        handle: AnyBuffer,
        value: int | tuple[int, int, int, int] = 0,
        offset: int = 0,
        size: int | None = None,
    ) -> None:
        """Fill ``size`` bytes (None: the rest) from ``offset`` with a 32-bit ``value`` or four."""
        length = handle.nbytes - offset if size is None else size
        words = (value,) if isinstance(value, int) else value
        step = 4 * len(words)
        if offset % step or length % step or offset + length > handle.nbytes:
            raise GraphError(f"clear {handle.name}: {length} bytes from {offset}")
        whole = length == handle.nbytes
        uses = self._transfer(ClearBuffer, c.BUFFER_UPDATE_BARRIER, target=handle, whole=whole)
        self.passes.append(ClearBuffer(f"clear {handle.name}", uses, words, offset, length))

    def copy_buffer(
        self,
        src: AnyBuffer,
        dst: AnyBuffer,
        size: int | None = None,
        src_offset: int = 0,
        dst_offset: int = 0,
    ) -> None:
        """Copy ``size`` bytes (None: as many as ``src`` has from ``src_offset``)."""
        length = src.nbytes - src_offset if size is None else size
        if src_offset + length > src.nbytes or dst_offset + length > dst.nbytes:
            raise GraphError(f"copy {src.name} to {dst.name}: {length} bytes do not fit")
        whole = length == dst.nbytes
        uses = self._transfer(Copy, c.BUFFER_UPDATE_BARRIER, src, dst, whole)
        node = Copy(f"copy {src.name}", uses)
        node.span = (src_offset, dst_offset, length)
        self.passes.append(node)

    def copy_texture(
        self,
        src: AnyTexture,
        dst: AnyTexture,
        layer: int | None = None,
        tile: tuple[int, int, int, int] | None = None,
    ) -> None:
        """Copy every texel of every level, of one ``layer``, or of a ``tile`` (x, y, width, height)
        of a texture of one level; both have one description."""
        if src.desc != dst.desc:
            raise GraphError(f"copy {src.name} to {dst.name}: {src.desc} is not {dst.desc}")
        if layer is not None and not 0 <= layer < (src.desc.layers or 0):
            raise GraphError(f"copy {src.name}: it has no layer {layer}")
        whole = layer is None and tile is None
        node = Copy(
            f"copy {src.name}", self._transfer(Copy, c.TEXTURE_UPDATE_BARRIER, src, dst, whole)
        )
        node.layer, node.tile = layer, tile
        self.passes.append(node)

    def read_later(self, buffer: AnyBuffer, callback: Callable[[bytes], None]) -> None:
        """Hand the bytes to ``callback`` two or three frames later; nothing waits."""
        uses = self._transfer(Readback, c.BUFFER_UPDATE_BARRIER, buffer)
        self.passes.append(Readback(f"read {buffer.name}", uses, callback))

    def execute(self) -> None:
        """Plan and run the frame. Raises PlanError, ShaderError, GlError (debug devices)."""
        if self._executed:
            raise GraphError("a graph runs once; begin a new frame")
        self._executed = True
        try:
            self.device.executor.run(self)
            self.has_run = True
        finally:  # draw callbacks may know the graph: else frames wait for the cycle collector
            self.passes.clear()

    # What frames share ---------------------------------------------------------------------------

    def _place(self, uses: Uses, params: Params) -> Sequence[Placed]:
        """Hand the values of a pass's uniform blocks to the frame's buffer."""
        add = self.device.params.add
        placed = []
        for slot, values in zip(uses.blocks, params.values(), strict=True):
            if slot.unit >= 0:
                offset, nbytes = add(values)
                if nbytes != slot.size:
                    check_block_size(slot, nbytes, uses.program)
                placed.append((slot.unit, offset, nbytes))
        return placed

    def _transfer(
        self,
        kind: type[Pass],
        bit: int,
        source: Resource | None = None,
        target: Resource | None = None,
        whole: bool = True,
    ) -> Uses:
        """The uses of a clear, a copy or a read-back; ``whole``: nothing of the target is kept."""
        key = (kind, bit, source, target, whole)
        uses = self._recall.uses.get(key)
        if uses is None:
            uses = Uses()
            uses.has_side_effect = kind is Readback
            for resource, used in (
                (source, uses.reads),
                (target, uses.overwrites if whole else uses.modifies),
            ):
                if resource is not None:
                    check_owner(self, resource)
                    used.append(resource)
                    uses.accesses.append((resource, bit, 0))
            self._recall.uses[key] = uses
        return uses


def _texture(name: str, size: tuple[int, ...], *shape: Any) -> TextureHandle:
    if min(size) < 1:
        raise GraphError(f"texture {name} can't have the size {size}")
    return TextureHandle(name, TextureDesc(size, *shape))
