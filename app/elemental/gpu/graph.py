"""The frame graph: passes by handles and GLSL names; it finds order, lifetimes and barriers.

[Mittring12 "Compositing Graph"]: "created each frame; dependencies define execution order; RT on
demand, ref. counting, lazy release".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from elemental.gpu import gl as c
from elemental.gpu.arguments import (
    Color,
    clear_list,
    group_counts,
    refuse_feedback,
    target_parts,
    triple,
)
from elemental.gpu.binding import (
    GraphError,
    Params,
    check_block_size,
    looks,
    name_plan,
    require_all,
)
from elemental.gpu.formats import Format
from elemental.gpu.passes import (
    Attachment,
    ClearBuffer,
    ClearTexture,
    ComputePass,
    Copy,
    Pass,
    RasterPass,
    Readback,
)
from elemental.gpu.plan import UNORDERED
from elemental.gpu.program import Program
from elemental.gpu.refs import (
    AnyBuffer,
    AnyTexture,
    BufferHandle,
    ImageRef,
    Ref,
    TextureHandle,
    Unordered,
)
from elemental.gpu.resources import Buffer, Texture
from elemental.gpu.shaders import Compute, Raster
from elemental.gpu.shape import TextureDesc, level_size
from elemental.gpu.state import DEFAULT, RasterState

if TYPE_CHECKING:
    from elemental.gpu.device import Device
    from elemental.gpu.encode import Encoder

AnyResource = Texture | TextureHandle | Buffer | BufferHandle


class Graph:
    """One frame. Declare passes, ``keep`` the outputs, ``execute``; made by ``begin_frame``."""

    __slots__ = ("_executed", "device", "has_run", "kept", "passes", "persistent", "resources")

    def __init__(self, device: Device) -> None:
        self.device = device
        self.passes: list[Pass] = []
        self.resources: list[AnyResource] = []
        self.persistent: set[int] = set()
        self.kept: set[int] = set()
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
        if min(size) < 1:
            raise GraphError(f"texture {name} can't have the size {size}")
        desc = TextureDesc(size, format, mips or 1, layers, cube)
        handle = TextureHandle(self, len(self.resources), name, desc)
        self.resources.append(handle)
        return handle

    def buffer(self, name: str, nbytes: int) -> BufferHandle:
        """A transient buffer of ``nbytes``."""
        handle = BufferHandle(self, len(self.resources), name, nbytes)
        self.resources.append(handle)
        return handle

    def keep(self, handle: AnyResource) -> None:
        """Make ``handle`` an output: valid until the device's next ``begin_frame``."""
        self.kept.add(self._index(handle))

    def _index(self, resource: AnyResource) -> int:
        if resource.graph is self:
            return resource.index
        if isinstance(resource, (Texture, Buffer)):
            resource.graph, resource.index = self, len(self.resources)
            self.persistent.add(resource.index)
            self.resources.append(resource)
            return resource.index
        raise GraphError(f"{getattr(resource, 'name', resource)!r} is no resource of this frame")

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
        program = self.device.program(shader)
        node = ComputePass(name or program.name, program)
        missing = self._bind(node, program, reads or {}, writes or {}, params or {})
        require_all(program, missing)
        if (threads is not None) + (groups is not None) + (indirect is not None) != 1:
            raise GraphError(f"{node.name}: give one of threads, groups and indirect")
        if indirect is not None:
            source, offset = indirect
            index = self._index(source)
            node.indirect = (index, offset)
            node.reads.append(index)
            node.accesses.append((index, c.COMMAND_BARRIER, False))
        elif threads is not None:
            node.groups = group_counts(triple(threads), program.local_size, program, node.name)
        elif groups is not None:
            node.groups = group_counts(triple(groups), (1, 1, 1), program, node.name)
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
        program = self.device.program(shader)
        node = RasterPass(name or program.name, program, state)
        targets = color if isinstance(color, (list, tuple)) else (color,)
        node.missing = self._bind(node, program, reads or {}, writes or {}, params or {})
        if draw is None:
            require_all(program, node.missing)
        node.draw, node.vertices, node.instances = draw, vertices, instances
        node.size = size or (0, 0)
        clears = clear_list(clear_color, len(targets), node.name)
        for target, clear in zip(targets, clears, strict=True):
            attachment = self._attach(node, target, cleared=clear is not None and tile is None)
            node.color.append((*attachment, clear))
        if depth is not None:
            writes_depth = state.depth_write and state.depth_test != "none"
            writes_depth |= clear_stencil is not None or clear_depth is not None
            writes_depth |= state.stencil is not None and state.stencil.writes
            cleared = clear_depth is not None and tile is None
            node.depth = self._attach(node, depth, cleared=cleared, written=writes_depth)
            node.clear_depth, node.clear_stencil = clear_depth, clear_stencil
        if node.size == (0, 0):
            raise GraphError(f"{node.name}: a pass without targets needs size=")
        node.viewport, node.tile = tile or viewport or (0, 0, *node.size), tile
        for used in uses:
            node.reads.append(self._index(used))
        self.passes.append(node)

    def clear_texture(self, handle: AnyTexture, color: Sequence[float] = (0, 0, 0, 0)) -> None:
        """Fill every level and layer."""
        node = ClearTexture(f"clear {handle.name}", self._index(handle), tuple(color))
        node.overwrites.append(node.resource)
        by_image = self.device.gl.has_clear_tex_image
        bit = c.TEXTURE_UPDATE_BARRIER if by_image else c.FRAMEBUFFER_BARRIER
        node.accesses.append((node.resource, bit, False))
        self.passes.append(node)

    def clear_buffer(
        self, handle: AnyBuffer, value: int = 0, offset: int = 0, size: int | None = None
    ) -> None:
        """Fill ``size`` bytes (None: the rest) from ``offset`` with the 32-bit ``value``."""
        length = handle.nbytes - offset if size is None else size
        if offset % 4 or length % 4 or offset + length > handle.nbytes:
            raise GraphError(f"clear {handle.name}: {length} bytes from {offset}")
        node = ClearBuffer(f"clear {handle.name}", self._index(handle), value, offset, length)
        whole = length == handle.nbytes
        (node.overwrites if whole else node.modifies).append(node.resource)
        node.accesses.append((node.resource, c.BUFFER_UPDATE_BARRIER, False))
        self.passes.append(node)

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
        node = Copy(f"copy {src.name}", self._index(src), self._index(dst))
        node.span = (src_offset, dst_offset, length)
        self._add_copy(node, c.BUFFER_UPDATE_BARRIER, length == dst.nbytes)

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
        node = Copy(f"copy {src.name}", self._index(src), self._index(dst))
        node.layer, node.tile = layer, tile
        self._add_copy(node, c.TEXTURE_UPDATE_BARRIER, layer is None and tile is None)

    def _add_copy(self, node: Copy, bit: int, whole: bool) -> None:
        node.reads.append(node.source)
        (node.overwrites if whole else node.modifies).append(node.target)
        node.accesses += [(node.source, bit, False), (node.target, bit, False)]
        self.passes.append(node)

    def read_later(self, buffer: AnyBuffer, callback: Callable[[bytes], None]) -> None:
        """Hand the bytes to ``callback`` two or three frames later; nothing waits."""
        node = Readback(f"read {buffer.name}", self._index(buffer), buffer.nbytes, callback)
        node.reads.append(node.resource)
        node.accesses.append((node.resource, c.BUFFER_UPDATE_BARRIER, False))
        self.passes.append(node)

    def execute(self) -> None:
        """Plan and run the frame. Raises PlanError, ShaderError, GlError (debug devices)."""
        if self._executed:
            raise GraphError("a graph runs once; begin a new frame")
        self._executed = True
        try:
            self.device.executor.run(self)
            self.has_run = True
        finally:  # handles know the graph: without this, each frame waits for the cycle collector
            self.passes.clear()
            self.resources.clear()

    # Binding -----------------------------------------------------------------------------------

    def _bind(
        self,
        node: Pass,
        program: Program,
        reads: Mapping[str, Ref],
        writes: Mapping[str, Ref],
        params: Params,
    ) -> frozenset[str]:
        plan = name_plan(program, reads, writes, params)
        bindings, accesses = node.bindings, node.accesses
        for slots, refs, used, written in (
            (plan.reads, reads, node.reads, False),
            (plan.writes, writes, node.modifies, True),
        ):
            for slot, given in zip(slots, refs.values(), strict=True):
                ref, access = given, int(written)
                if type(given) is Unordered:
                    ref, access = given.buffer, UNORDERED * access
                for look, resource in looks(slot, ref, program):
                    index = resource.index if resource.graph is self else self._index(resource)
                    used.append(index)
                    if slot.unit >= 0:
                        bindings.append((look, index))
                        accesses.append((index, look.barrier, access))
        for slot, values in zip(plan.params, params.values(), strict=True):
            if slot.unit >= 0:
                raw = values.tobytes()
                if len(raw) != slot.size:
                    check_block_size(slot, len(raw), program)
                node.params.append((slot.unit, self.device.params.add(raw), len(raw)))
        return plan.missing

    def _attach(
        self, node: RasterPass, target: ImageRef, *, cleared: bool, written: bool = True
    ) -> Attachment:
        """Note how a render target is used; all targets of a pass have one size."""
        texture, level, layer = target_parts(target)
        index, desc = self._index(texture), texture.desc
        if index in node.reads or index in node.modifies:
            refuse_feedback(node, (index, level, layer), texture.name)
        if cleared and desc.mips == 1 and (layer < 0 or desc.slices == 1):
            node.overwrites.append(index)
        elif written or cleared:
            node.modifies.append(index)
        else:
            node.reads.append(index)
        node.accesses.append((index, c.FRAMEBUFFER_BARRIER, False))
        size = desc.size[:2] if level == 0 else level_size(desc.size, level)[:2]
        if node.size != size:
            if node.size != (0, 0):
                width, height = size
                raise GraphError(
                    f"{node.name}: {texture.name} is {width}x{height}, not {node.size}"
                )
            node.size = (size[0], size[1])
        return index, level, layer
