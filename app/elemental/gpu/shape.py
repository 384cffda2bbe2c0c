"""What a texture is made of: size, format, levels, layers; no GL calls."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import ClassVar
from weakref import WeakValueDictionary

from elemental.gpu import gl as c
from elemental.gpu.formats import Format

_FACES = 6


@dataclass(frozen=True, slots=True, eq=False)
class TextureKind:
    """What decides how a texture is bound: everything about it but width and height."""

    format: Format
    mips: int
    target: int
    slices: int


@cache
def _kind(format: Format, mips: int, target: int, slices: int) -> TextureKind:
    """The one kind of these values: a window that is being resized has few."""
    return TextureKind(format, mips, target, slices)


class TextureDesc:
    """What a texture is made of. Equal descriptions are one object and share pooled targets."""

    __slots__ = (
        "__weakref__", "cube", "format", "kind", "layers", "mips", "nbytes", "size", "slices",
        "target",
    )  # fmt: skip
    size: tuple[int, ...]
    """(width, height) or (width, height, depth) texels."""
    format: Format
    mips: int
    layers: int | None
    """Layers of an array (of cubes, where ``cube``); None: no array."""
    cube: bool
    target: int
    """GL texture target."""
    slices: int
    """Two-dimensional images at level 0: depth, layers or faces."""
    kind: TextureKind
    nbytes: int
    """Bytes of all levels, without the driver's padding."""

    _known: ClassVar[WeakValueDictionary[tuple[object, ...], TextureDesc]] = WeakValueDictionary()
    """Those in use: a window that is being resized must not fill memory."""

    def __new__(
        cls,
        size: tuple[int, ...],
        format: Format,
        mips: int = 1,
        layers: int | None = None,
        cube: bool = False,
    ) -> TextureDesc:
        """The one description of these values."""
        key = (size, format, mips, layers, cube)
        known = cls._known.get(key)
        if known is None:
            known = super().__new__(cls)
            known.size, known.format, known.mips = size, format, mips
            known.layers, known.cube = layers, cube
            known.target = _target(size, layers, cube)
            known.slices = size[2] if len(size) == 3 else (layers or 1) * (_FACES if cube else 1)
            known.kind = _kind(format, mips, known.target, known.slices)
            extents = [level_size(size, level) for level in range(mips)]
            texels = sum(math.prod(extent) for extent in extents)
            flat = 1 if len(size) == 3 else known.slices
            known.nbytes = texels * flat * format.texel_bytes
            cls._known[key] = known
        return known

    def __repr__(self) -> str:
        return f"TextureDesc({self.size}, {self.format}, {self.mips}, {self.layers}, {self.cube})"


def _target(size: tuple[int, ...], layers: int | None, cube: bool) -> int:
    if cube:
        return c.TEXTURE_CUBE_MAP if layers is None else c.TEXTURE_CUBE_MAP_ARRAY
    if len(size) == 3:
        return c.TEXTURE_3D
    return c.TEXTURE_2D if layers is None else c.TEXTURE_2D_ARRAY


def level_size(size: tuple[int, ...], level: int) -> tuple[int, ...]:
    """Texels along each axis at mip ``level``."""
    return tuple(max(1, extent >> level) for extent in size)


class Shaped:
    """Read access to a description, shared by physical textures and graph handles."""

    __slots__ = ("desc", "name")
    desc: TextureDesc
    name: str

    @property
    def size(self) -> tuple[int, ...]:
        """(width, height) or (width, height, depth) at level 0."""
        return self.desc.size

    @property
    def width(self) -> int:
        """Texels along x at level 0."""
        return self.desc.size[0]

    @property
    def height(self) -> int:
        """Texels along y at level 0."""
        return self.desc.size[1]

    @property
    def format(self) -> Format:
        """Texel format."""
        return self.desc.format

    @property
    def mips(self) -> int:
        """Mip levels."""
        return self.desc.mips

    @property
    def layers(self) -> int | None:
        """Array layers, None where it is no array."""
        return self.desc.layers
