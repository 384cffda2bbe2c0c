"""The arguments of passes brought to one form; no GL calls."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from elemental.gpu.binding import BlockLook, GraphError, Look, SamplerLook, TexelsLook
from elemental.gpu.gl import MAX_WORK_GROUPS
from elemental.gpu.program import Program
from elemental.gpu.refs import AnyTexture, ImageRef, Layer, Mip

_ALL_LEVELS = 32
Color = tuple[float, float, float, float]


def target_parts(target: ImageRef) -> tuple[AnyTexture, int, int]:
    """(texture, level, layer or -1) of a render target. Raises GraphError."""
    if isinstance(target, Mip):
        texture, level, layer = target.texture, target.level, -1
    elif isinstance(target, Layer):
        texture, level, layer = target.texture, target.level, target.layer
    else:
        return target, 0, -1
    if not 0 <= level < texture.desc.mips or not -1 <= layer < texture.desc.slices:
        raise GraphError(f"{texture.name} has no level {level}, layer {layer}")
    return texture, level, layer


def clear_list(
    clear: Color | Sequence[Color | None] | None, count: int, name: str
) -> Sequence[Color | None]:
    """A clear colour, or None, for each of ``count`` targets. Raises GraphError."""
    if clear is None:
        return [None] * count
    if isinstance(clear, (list, tuple)) and all(np.isscalar(value) for value in clear):
        return [clear] * count  # type: ignore[list-item]
    if len(clear) != count:
        raise GraphError(f"{name}: {len(clear)} clear colours for {count} targets")
    return clear  # type: ignore[return-value]


def triple(extent: int | Sequence[int]) -> tuple[int, int, int]:
    """Three extents; what is not given is 1."""
    if isinstance(extent, (int, np.integer)):
        return int(extent), 1, 1
    x, y, z = (*extent, 1, 1)[:3]
    return int(x), int(y), int(z)


def group_counts(
    extent: tuple[int, int, int], local: tuple[int, int, int], program: Program, name: str
) -> tuple[int, int, int]:
    """Groups that cover ``extent``; a long single dimension is folded into two.

    Raises GraphError past 65,535 groups where the shader can't be folded.
    """
    x, y, z = (-(-n // size) for n, size in zip(extent, local, strict=True))
    if x <= MAX_WORK_GROUPS and y <= MAX_WORK_GROUPS and z <= MAX_WORK_GROUPS:
        return x, y, z
    if y == z == 1 and program.linear_dispatch:
        rows = -(-x // MAX_WORK_GROUPS)
        return -(-x // rows), rows, 1
    raise GraphError(
        f"{name}: {(x, y, z)} groups exceed {MAX_WORK_GROUPS} along one axis; a one-dimensional "
        "dispatch may, if the shader uses linear_thread_id() of lib/dispatch.glsl"
    )


def refuse_feedback(
    name: str, bindings: Sequence[tuple[Look, object]], attached: tuple[AnyTexture, int, int]
) -> None:
    """Raise GraphError where pass ``name`` reads the very level and layer that it renders to.

    GL leaves the result undefined, with the writes of depth off, too [GL 4.3, 9.3.1: only texture
    barriers, of GL 4.5, define it]; software drivers hide it.
    """
    texture, target_level, target_layer = attached
    for look, resource in bindings:
        if resource is not texture or isinstance(look, (BlockLook, TexelsLook)):
            continue
        if isinstance(look, SamplerLook):
            _, level, levels, layer, _ = look.view or (0, 0, _ALL_LEVELS, -1, False)
        else:
            level, levels, layer = look.level, 1, -1 if look.layered else look.layer
        same_level = level <= target_level < level + levels
        if same_level and (layer == target_layer or -1 in (layer, target_layer)):
            raise GraphError(f"{name}: {texture.name} is rendered to and read in one pass")
