"""Texel formats: the names the passes use, and what GL calls them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from elemental.gpu import gl as c

_BYTE, _UNSIGNED_BYTE, _UNSIGNED_SHORT, _FLOAT, _HALF = 0x1400, 0x1401, 0x1403, 0x1406, 0x140B
_UINT_2_10_10_10_REV, _UINT_24_8 = 0x8368, 0x84FA
_RED, _RGB, _RGBA, _RG = 0x1903, 0x1907, 0x1908, 0x8227
_RGBA_INTEGER, _RG_INTEGER = 0x8D99, 0x8228


@dataclass(frozen=True, slots=True, eq=False)
class Format:
    """A texel format. Compared by identity; the module constants are the only instances."""

    name: str
    internal: int
    """GL internal format."""
    transfer: int
    """GL format of uploads and read-backs."""
    transfer_type: int
    """GL type of uploads and read-backs."""
    dtype: np.dtype[np.generic]
    """Element of an upload or a read-back."""
    channels: int
    """Elements of ``dtype`` a texel in an upload or a read-back."""
    texel_bytes: int
    """Bytes a texel in video memory."""
    kind: str = "float"
    """float, uint, depth or depth_stencil."""

    @property
    def is_depth(self) -> bool:
        """True for depth and depth-stencil formats."""
        return self.kind.startswith("depth")

    @property
    def filterable(self) -> bool:
        """True where linear filtering is meaningful."""
        return self.kind == "float"

    def __repr__(self) -> str:
        return self.name


def _f(
    name: str, internal: int, transfer: tuple[int, int, str, int], size: int, family: str = "float"
) -> Format:
    fmt, kind, dtype, channels = transfer
    return Format(name, internal, fmt, kind, np.dtype(dtype), channels, size, family)


RGBA8 = _f("RGBA8", 0x8058, (_RGBA, _UNSIGNED_BYTE, "u1", 4), 4)
RGBA8_SNORM = _f("RGBA8_SNORM", 0x8F97, (_RGBA, _BYTE, "i1", 4), 4)
SRGB8_A8 = _f("SRGB8_A8", 0x8C43, (_RGBA, _UNSIGNED_BYTE, "u1", 4), 4)
RGB10_A2 = _f("RGB10_A2", 0x8059, (_RGBA, _UINT_2_10_10_10_REV, "u4", 1), 4)
RGBA16F = _f("RGBA16F", 0x881A, (_RGBA, _HALF, "f2", 4), 8)
RGBA32F = _f("RGBA32F", 0x8814, (_RGBA, _FLOAT, "f4", 4), 16)
R11F_G11F_B10F = _f("R11F_G11F_B10F", 0x8C3A, (_RGB, _FLOAT, "f4", 3), 4)
R8 = _f("R8", 0x8229, (_RED, _UNSIGNED_BYTE, "u1", 1), 1)
RG8 = _f("RG8", 0x822B, (_RG, _UNSIGNED_BYTE, "u1", 2), 2)
R16F = _f("R16F", 0x822D, (_RED, _HALF, "f2", 1), 2)
R32F = _f("R32F", 0x822E, (_RED, _FLOAT, "f4", 1), 4)
RG16F = _f("RG16F", 0x822F, (_RG, _HALF, "f2", 2), 4)
RG32F = _f("RG32F", 0x8230, (_RG, _FLOAT, "f4", 2), 8)
R32UI = _f("R32UI", c.R32UI, (c.RED_INTEGER, c.UNSIGNED_INT, "u4", 1), 4, "uint")
RG32UI = _f("RG32UI", 0x823C, (_RG_INTEGER, c.UNSIGNED_INT, "u4", 2), 8, "uint")
RGBA32UI = _f("RGBA32UI", 0x8D70, (_RGBA_INTEGER, c.UNSIGNED_INT, "u4", 4), 16, "uint")
RGBA8UI = _f("RGBA8UI", 0x8D7C, (_RGBA_INTEGER, _UNSIGNED_BYTE, "u1", 4), 4, "uint")
D16 = _f("D16", 0x81A5, (c.DEPTH_COMPONENT, _UNSIGNED_SHORT, "u2", 1), 2, "depth")
D32F = _f("D32F", 0x8CAC, (c.DEPTH_COMPONENT, _FLOAT, "f4", 1), 4, "depth")
D24S8 = _f("D24S8", 0x88F0, (c.DEPTH_STENCIL, _UINT_24_8, "u4", 1), 4, "depth_stencil")

IMAGE_QUALIFIERS: dict[str, int] = {
    "rgba8": 0x8058, "rgb10_a2": 0x8059, "rgba16f": 0x881A, "rgba32f": 0x8814,
    "r11f_g11f_b10f": 0x8C3A, "r8": 0x8229, "rg8": 0x822B, "r16f": 0x822D, "r32f": 0x822E,
    "rg16f": 0x822F, "rg32f": 0x8230, "r32ui": 0x8236, "rg32ui": 0x823C, "rgba32ui": 0x8D70,
    "rgba8ui": 0x8D7C, "r32i": 0x8235, "rgba16": 0x805B, "rgba8_snorm": 0x8F97,
}  # fmt: skip
"""GLSL ``layout(...)`` qualifiers of images -> GL formats."""
