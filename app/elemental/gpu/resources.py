"""Textures and buffers on the device, and the small words by which a pass refers to them."""

from __future__ import annotations

import ctypes
import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from elemental.gpu import gl as c
from elemental.gpu.shape import Shaped, TextureDesc, level_size

if TYPE_CHECKING:
    from elemental.gpu.device import Device

_serial = itertools.count(1)


def mip_count(size: tuple[int, ...]) -> int:
    """Levels of a full mip chain."""
    return max(size).bit_length()


class Texture(Shaped):
    """A texture of immutable storage on the device; ``release`` frees it and its views."""

    __slots__ = (
        "category", "device", "glo", "ordered_at", "serial", "target", "unordered_at", "views",
        "written_at",
    )  # fmt: skip

    def __init__(self, device: Device, name: str, desc: TextureDesc, category: str) -> None:
        self.device, self.name, self.desc, self.category = device, name, desc, category
        self.target = desc.target
        self.serial = next(_serial)
        self.views: dict[tuple[int, int, int, int, bool], int] = {}
        self.written_at = self.unordered_at = self.ordered_at = 0
        gl = device.gl
        self.glo = gl.generate("Textures")
        device.bind_for_update(self.target, self.glo)
        internal = desc.format.internal
        if self.target in (c.TEXTURE_2D, c.TEXTURE_CUBE_MAP):
            gl.glTexStorage2D(self.target, desc.mips, internal, *desc.size)
        else:
            gl.glTexStorage3D(self.target, desc.mips, internal, *desc.size[:2], desc.slices)
        gl.label(c.LABEL_TEXTURE, self.glo, name)
        device.allocated(self, desc.nbytes)

    @property
    def nbytes(self) -> int:
        """Bytes of all levels."""
        return self.desc.nbytes

    def extent(self, level: int) -> tuple[int, int, int]:
        """(width, height, slices) of ``level``."""
        width, height, *depth = level_size(self.size, level)
        return width, height, depth[0] if depth else self.desc.slices

    def view(self, target: int, level: int, levels: int, layer: int, stencil: bool = False) -> int:
        """GL name of a view of ``levels`` levels from ``level``, seen as ``target``.

        ``layer`` -1 takes all layers; ``stencil`` samples the stencil of a depth-stencil texture.
        """
        if not stencil and target == self.target and (level, levels, layer) == (0, self.mips, -1):
            return self.glo
        key = (target, level, levels, layer, stencil)
        glo = self.views.get(key)
        if glo is None:
            gl = self.device.gl
            glo = self.views[key] = gl.generate("Textures")
            slices = 1 if target == c.TEXTURE_3D else self.desc.slices
            first, count = (0, slices) if layer < 0 else (layer, 1)
            internal = self.desc.format.internal
            gl.glTextureView(glo, target, self.glo, internal, level, levels, first, count)
            self.device.bind_for_update(target, glo)
            if stencil:
                gl.glTexParameteri(target, c.DEPTH_STENCIL_TEXTURE_MODE, c.STENCIL_INDEX)
            gl.label(c.LABEL_TEXTURE, glo, f"{self.name} view")
        return glo

    def write(
        self, pixels: npt.NDArray[Any] | bytes, level: int = 0, layer: int | None = None
    ) -> None:
        """Upload one level (of one layer): rows bottom up, the format's own element type.

        Raises ValueError where the size does not fit.
        """
        fmt, gl = self.desc.format, self.device.gl
        size = level_size(self.size, level)
        depth = size[2] if len(size) == 3 else (self.desc.slices if layer is None else 1)
        raw = pixels if isinstance(pixels, bytes) else np.ascontiguousarray(pixels).tobytes()
        expected = size[0] * size[1] * depth * fmt.channels * fmt.dtype.itemsize
        if len(raw) != expected:
            raise ValueError(f"texture {self.name}: {len(raw)} bytes given, {expected} needed")
        self.device.bind_for_update(self.target, self.glo)
        self.device.executor.hazards.touched(self)
        gl.glPixelStorei(c.UNPACK_ALIGNMENT, 1)
        gl.glMemoryBarrier(c.TEXTURE_UPDATE_BARRIER)
        kind = (fmt.transfer, fmt.transfer_type)
        first = layer or 0
        if self.target == c.TEXTURE_2D:
            gl.glTexSubImage2D(self.target, level, 0, 0, size[0], size[1], *kind, raw)
        elif self.target == c.TEXTURE_CUBE_MAP:
            step = expected // depth
            for face in range(depth):
                part = raw[face * step : (face + 1) * step]
                target = c.TEXTURE_CUBE_MAP_POSITIVE_X + first + face
                gl.glTexSubImage2D(target, level, 0, 0, size[0], size[1], *kind, part)
        else:
            extent = (size[0], size[1], depth)
            gl.glTexSubImage3D(self.target, level, 0, 0, first, *extent, *kind, raw)

    def generate_mips(self) -> None:
        """Fill levels 1 and up by the driver's box filter."""
        self.device.bind_for_update(self.target, self.glo)
        self.device.executor.hazards.touched(self)
        self.device.gl.glMemoryBarrier(c.TEXTURE_UPDATE_BARRIER | c.TEXTURE_FETCH_BARRIER)
        self.device.gl.glGenerateMipmap(self.target)

    def read(self, level: int = 0) -> npt.NDArray[Any]:
        """Waits for the GPU. ([slices,] H, W[, channels]) in the format's element type, row 0 last.

        Row 0 of the array is the bottom row (GL order). Not for frames: use ``Graph.read_later``.
        """
        fmt, gl = self.desc.format, self.device.gl
        width, height, slices = self.extent(level)
        shape = (slices, height, width, fmt.channels)
        pixels = np.empty(shape, fmt.dtype)
        gl.glMemoryBarrier(c.ALL_BARRIERS)
        self.device.bind_for_update(self.target, self.glo)
        gl.glPixelStorei(c.PACK_ALIGNMENT, 1)
        kind = (fmt.transfer, fmt.transfer_type)
        if self.target == c.TEXTURE_CUBE_MAP:
            for face in range(slices):
                address = ctypes.c_void_p(pixels[face].ctypes.data)
                gl.glGetTexImage(c.TEXTURE_CUBE_MAP_POSITIVE_X + face, level, *kind, address)
        else:
            gl.glGetTexImage(self.target, level, *kind, ctypes.c_void_p(pixels.ctypes.data))
        if fmt.channels == 1:
            pixels = pixels[..., 0]
        return pixels[0] if self.target == c.TEXTURE_2D else pixels

    def release(self) -> None:
        """Free the texture, its views and every framebuffer that holds it."""
        if self.glo:
            self.device.released(self)
            for view in self.views.values():
                self.device.gl.delete("Textures", view)
            self.views.clear()
            self.device.gl.delete("Textures", self.glo)
            self.glo = 0

    def __repr__(self) -> str:
        return f"Texture({self.name!r}, {self.size}, {self.format})"


class Buffer:
    """A buffer on the device."""

    __slots__ = (
        "category", "device", "glo", "mgl", "name", "nbytes", "ordered_at", "serial", "texels",
        "unordered_at", "written_at",
    )  # fmt: skip

    def __init__(
        self,
        device: Device,
        name: str,
        contents: bytes | int,
        category: str,
        dynamic: bool = True,
    ) -> None:
        nbytes = contents if isinstance(contents, int) else len(contents)
        self.device, self.name, self.nbytes, self.category = device, name, nbytes, category
        self.serial = next(_serial)
        self.written_at = self.unordered_at = self.ordered_at = 0
        given: dict[str, Any] = {"reserve" if isinstance(contents, int) else "data": contents}
        self.texels = 0
        """GL name of the buffer texture, once it was asked for."""
        self.mgl: moderngl.Buffer = device.ctx.buffer(**given, dynamic=dynamic)
        self.glo: int = self.mgl.glo
        device.gl.label(c.LABEL_BUFFER, self.glo, name)
        device.allocated(self, nbytes)

    def write(self, values: npt.NDArray[Any] | bytes, offset: int = 0) -> None:
        """Overwrite bytes from ``offset``."""
        raw = values if isinstance(values, bytes) else np.ascontiguousarray(values).tobytes()
        self.device.executor.hazards.touched(self)
        self.device.gl.glMemoryBarrier(c.BUFFER_UPDATE_BARRIER)
        self.mgl.write(raw, offset)

    def read(
        self, dtype: npt.DTypeLike = np.uint8, count: int = -1, offset: int = 0
    ) -> npt.NDArray[Any]:
        """Waits for the GPU. ``count`` elements (-1: to the end) from byte ``offset``."""
        element = np.dtype(dtype)
        if count < 0:
            count = (self.nbytes - offset) // element.itemsize
        self.device.gl.glMemoryBarrier(c.ALL_BARRIERS)
        return np.frombuffer(self.mgl.read(count * element.itemsize, offset), element)

    def as_texels(self) -> int:
        """GL name of a buffer texture of it: RGBA32UI, 16 bytes a texel."""
        if not self.texels:
            gl = self.device.gl
            self.texels = gl.generate("Textures")
            self.device.bind_for_update(c.TEXTURE_BUFFER, self.texels)
            gl.glTexBuffer(c.TEXTURE_BUFFER, c.RGBA32UI, self.glo)
            gl.label(c.LABEL_TEXTURE, self.texels, f"{self.name} texels")
        return self.texels

    def release(self) -> None:
        """Free the buffer and its texture."""
        if self.glo:
            self.device.released(self)
            if self.texels:
                self.device.gl.delete("Textures", self.texels)
                self.texels = 0
            self.mgl.release()
            self.glo = 0

    def __repr__(self) -> str:
        return f"Buffer({self.name!r}, {self.nbytes} bytes)"


class VertexInput:
    """Vertex and index buffers by attribute name; a vertex array is made per program on demand."""

    __slots__ = ("accesses", "content", "device", "index", "serial")

    def __init__(
        self,
        device: Device,
        content: Sequence[tuple[Buffer, str, Sequence[str]]],
        index: Buffer | None,
    ) -> None:
        self.device, self.index = device, index
        self.content = [(buffer, layout, tuple(names)) for buffer, layout, names in content]
        read = dict.fromkeys(buffer for buffer, _, _ in self.content)
        self.accesses = [(buffer, c.VERTEX_ATTRIB_ARRAY_BARRIER, 0) for buffer in read]
        """What a draw from it reads; see `Hazards`."""
        if index is not None:
            self.accesses.append((index, c.ELEMENT_ARRAY_BARRIER, 0))
        self.serial = next(_serial)

    def release(self) -> None:
        """Free the vertex arrays made for it; the buffers stay."""
        self.device.forget_vertex_input(self.serial)
