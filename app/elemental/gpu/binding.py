"""From the GLSL names of a pass to units, views and barrier bits; no GL calls.

What a reference means at a slot (its *look*) depends on the slot and on the texture's kind alone,
so it is worked out once and kept with the slot; a frame only adds the resource.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from elemental.gpu import gl as c
from elemental.gpu.program import IMAGE, SAMPLER, STORAGE_BLOCK, UNIFORM_BLOCK, Program, Slot
from elemental.gpu.refs import (
    AnyBuffer,
    AnyTexture,
    BufferHandle,
    Layer,
    Mip,
    Ref,
    Sampled,
    SamplerKey,
    TextureHandle,
)
from elemental.gpu.resources import Buffer, Texture
from elemental.gpu.shape import TextureKind

Params = Mapping[str, npt.NDArray[np.void]]


class GraphError(Exception):
    """A pass that can't be recorded; the message names the shader and the name in question."""


@dataclass(frozen=True, slots=True, eq=False)
class SamplerLook:
    """A texture seen through a sampler."""

    unit: int
    target: int
    sampler: SamplerKey
    view: tuple[int, int, int, int, bool] | None
    """Arguments of Texture.view; None: the texture itself."""
    barrier: int = c.TEXTURE_FETCH_BARRIER


@dataclass(frozen=True, slots=True, eq=False)
class ImageLook:
    """A texture level as an image."""

    unit: int
    view: tuple[int, int, int, int, bool] | None
    level: int
    layered: bool
    layer: int
    access: int
    format: int
    barrier: int = c.SHADER_IMAGE_ACCESS_BARRIER


@dataclass(frozen=True, slots=True, eq=False)
class BlockLook:
    """A buffer as a storage block or as a uniform block."""

    unit: int
    target: int
    barrier: int


@dataclass(frozen=True, slots=True, eq=False)
class TexelsLook:
    """A buffer seen through a usamplerBuffer: 16 bytes a texel."""

    unit: int
    barrier: int = c.TEXTURE_FETCH_BARRIER


TEXEL_BYTES = 16
Look = SamplerLook | ImageLook | BlockLook | TexelsLook
Bound = tuple[Look, AnyTexture | AnyBuffer]
_Part = tuple[int, int, int]
"""(level, layer, element of the sampler array); -1: all levels, all layers."""


class NamePlan(NamedTuple):
    """The slots behind the names of a pass, checked once per program and set of names."""

    reads: tuple[Slot, ...]
    writes: tuple[Slot, ...]
    params: tuple[Slot, ...]
    missing: frozenset[str]
    """Active names that are not given; a draw callback may still bind them."""


def name_plan(
    program: Program, reads: Iterable[str], writes: Iterable[str], params: Iterable[str]
) -> NamePlan:
    """Look up and check names. Raises GraphError for one that the program does not declare."""
    key = (tuple(reads), tuple(writes), tuple(params))
    plan: NamePlan | None = program.plans.get(key)
    if plan is None:
        read_slots = tuple(_slot(program, name, "reads") for name in key[0])
        write_slots = tuple(_slot(program, name, "writes") for name in key[1])
        param_slots = tuple(_slot(program, name, "params") for name in key[2])
        given = {*key[0], *key[1], *key[2]}
        if len(given) < len(key[0]) + len(key[1]) + len(key[2]):
            raise GraphError(f"{program.shader!r}: a name is given twice among {sorted(given)}")
        active = {name for name, slot in program.slots.items() if slot.active}
        plan = NamePlan(read_slots, write_slots, param_slots, frozenset(active - given))
        program.plans[key] = plan
    return plan


def _slot(program: Program, name: str, given_as: str) -> Slot:
    slot = program.slots.get(name)
    if slot is None:
        known = ", ".join(sorted(program.slots)) or "nothing"
        raise GraphError(f"{program.shader!r}: no {name} (in {given_as}); it declares {known}")
    problem = ""
    if given_as == "writes":
        if slot.kind in (SAMPLER, UNIFORM_BLOCK):
            problem = f"a {slot.kind} can't be written"
        elif slot.kind == IMAGE and slot.access == c.READ_ONLY:
            problem = "it is readonly in the shader"
    elif given_as == "reads" and slot.kind == IMAGE and slot.access == c.WRITE_ONLY:
        problem = "it is writeonly in the shader"
    elif given_as == "params" and slot.kind != UNIFORM_BLOCK:
        problem = f"it is a {slot.kind}, not a uniform block"
    if problem:
        raise GraphError(f"{program.shader!r}: {name} is given in {given_as}, but {problem}")
    return slot


def require_all(program: Program, missing: Iterable[str]) -> None:
    """Raise GraphError if a name that the program uses is not bound."""
    names = sorted(missing)
    if names:
        raise GraphError(f"{program.shader!r}: {', '.join(names)} not bound")


def check_block_size(slot: Slot, nbytes: int, program: Program) -> None:
    """Raise GraphError where packed values do not fill the uniform block."""
    if -(-slot.size // 16) != -(-nbytes // 16):
        raise GraphError(
            f"{program.shader!r}: block {slot.name} has {slot.size} bytes, {nbytes} given"
        )


def looks(slot: Slot, ref: Ref, program: Program) -> Sequence[Bound]:
    """What is bound for ``ref`` at ``slot``: one (look, resource), or one for each array element.

    Raises GraphError where it does not fit.
    """
    if isinstance(ref, (Texture, TextureHandle)):
        known: Look | None = slot.looks.get(ref.desc.kind)
        if known is not None:
            return ((known, ref),)
    if slot.kind in (STORAGE_BLOCK, UNIFORM_BLOCK):
        return (_block(slot, ref, program),)
    if isinstance(ref, (Buffer, BufferHandle)):
        return (_texels(slot, ref, program),)
    bound = _elements(slot, ref, program)
    if isinstance(ref, (Texture, TextureHandle)):
        slot.looks[ref.desc.kind] = bound[0][0]
    return bound


def _elements(slot: Slot, ref: Ref, program: Program) -> list[Bound]:
    elements: Sequence[Any] = ref if type(ref) is tuple else (ref,)  # no words, which are tuples
    if slot.active and len(elements) != slot.count:
        raise GraphError(
            f"{program.shader!r}: {slot.name} takes {slot.count} textures, {len(elements)} given"
        )
    return [_texture(slot, element, offset, program) for offset, element in enumerate(elements)]


def _block(slot: Slot, ref: Ref, program: Program) -> Bound:
    if not isinstance(ref, (Buffer, BufferHandle)):
        raise GraphError(f"{program.shader!r}: {slot.name} is a block, {ref!r} is no buffer")
    storage = slot.kind == STORAGE_BLOCK
    if storage and ref.nbytes > program.storage_limit:
        raise GraphError(
            f"{program.shader!r}: {slot.name}: {ref.name} has {ref.nbytes} bytes, "
            f"this driver binds at most {program.storage_limit}"
        )
    look: BlockLook | None = slot.looks.get(None)
    if look is None:
        target = c.SHADER_STORAGE_BUFFER if storage else c.UNIFORM_BUFFER
        barrier = c.SHADER_STORAGE_BARRIER if storage else c.UNIFORM_BARRIER
        look = slot.looks[None] = BlockLook(slot.unit, target, barrier)
    return look, ref


def _texels(slot: Slot, buffer: AnyBuffer, program: Program) -> Bound:
    if slot.kind != SAMPLER or (slot.active and slot.target != c.TEXTURE_BUFFER):
        raise GraphError(f"{program.shader!r}: {slot.name} needs a texture, not {buffer!r}")
    if buffer.nbytes > program.texel_limit * TEXEL_BYTES:
        raise GraphError(
            f"{program.shader!r}: {slot.name}: {buffer.name} has {buffer.nbytes} bytes, this "
            f"driver's buffer textures at most {program.texel_limit * TEXEL_BYTES}"
        )
    look: TexelsLook | None = slot.looks.get(None)
    if look is None:
        look = slot.looks[None] = TexelsLook(slot.unit)
    return look, buffer


def _texture(slot: Slot, ref: object, offset: int, program: Program) -> Bound:
    sampling: tuple[Any, ...] = ()
    inner = ref
    if isinstance(ref, Sampled):
        inner = ref.texture
        sampling = (ref.filter, ref.wrap, ref.compare, ref.border, ref.anisotropy, ref.stencil)
        if slot.kind != SAMPLER:
            raise GraphError(f"{program.shader!r}: {slot.name} is an image, it can't be sampled")
    if isinstance(inner, (Texture, TextureHandle)):
        texture, level, layer = inner, -1, -1
    elif isinstance(inner, Mip):
        texture, level, layer = inner.texture, inner.level, -1
    elif isinstance(inner, Layer):
        texture, level, layer = inner.texture, inner.level, inner.layer
    else:
        raise GraphError(f"{program.shader!r}: {slot.name} needs a texture, not {ref!r}")
    part = (level, layer, offset)
    key = (texture.desc.kind, part, sampling)
    look: Look | None = slot.looks.get(key)
    if look is None:
        try:
            make = _sampler_look if slot.kind == SAMPLER else _image_look
            look = slot.looks[key] = make(slot, texture.desc.kind, part, sampling)
        except ValueError as error:
            reason = f"{slot.name}: {texture.name} {error}"
            raise GraphError(f"{program.shader!r}: {reason}") from None
    return look, texture


def _sampler_look(
    slot: Slot, kind: TextureKind, part: _Part, sampling: tuple[Any, ...]
) -> SamplerLook:
    level, layer, offset = _checked(kind, part)
    filter_, wrap, compare, border, anisotropy, stencil = sampling or (
        None, "clamp", slot.shadow, 0.0, 1.0, False,
    )  # fmt: skip
    if slot.active and slot.shadow != compare:
        raise ValueError("is sampled with compare" if compare else "is sampled without compare")
    if layer >= 0 and kind.target == c.TEXTURE_3D:
        raise ValueError("is 3D: a slice can't be sampled alone")
    if slot.target == c.TEXTURE_BUFFER:
        raise ValueError("is no buffer")
    target = c.TEXTURE_2D if layer >= 0 else kind.target
    if slot.active and target != slot.target:
        _check_viewable(slot, kind, layer)
        target = slot.target
    smooth = kind.format.filterable or compare
    key = (filter_ or ("linear" if smooth else "nearest"), wrap, compare, border, anisotropy)
    levels = kind.mips if level < 0 else 1
    view = (target, max(level, 0), levels, layer, stencil)
    whole = view == (kind.target, 0, kind.mips, -1, False)
    return SamplerLook(slot.unit + offset, target, key, None if whole else view)


def _image_look(slot: Slot, kind: TextureKind, part: _Part, _: tuple[Any, ...]) -> ImageLook:
    level, layer, offset = _checked(kind, part)
    view = None
    if layer < 0 and slot.active and slot.target != kind.target:
        _check_viewable(slot, kind, layer)
        view = (slot.target, 0, kind.mips, -1, False)
    layered = layer < 0 and kind.target != c.TEXTURE_2D
    fmt = slot.image_format or kind.format.internal
    unit = slot.unit + offset
    return ImageLook(unit, view, max(level, 0), layered, max(layer, 0), slot.access, fmt)


def _checked(kind: TextureKind, part: _Part) -> _Part:
    level, layer, _ = part
    if not -1 <= level < kind.mips or not -1 <= layer < kind.slices:
        raise ValueError(f"has no level {level}, layer {layer}")
    return part


_TARGET_NAMES = {
    c.TEXTURE_2D: "2D", c.TEXTURE_3D: "3D", c.TEXTURE_2D_ARRAY: "2DArray",
    c.TEXTURE_CUBE_MAP: "Cube", c.TEXTURE_CUBE_MAP_ARRAY: "CubeArray",
}  # fmt: skip
_FLAT = {c.TEXTURE_2D, c.TEXTURE_2D_ARRAY, c.TEXTURE_CUBE_MAP, c.TEXTURE_CUBE_MAP_ARRAY}


def _check_viewable(slot: Slot, kind: TextureKind, layer: int) -> None:
    """glTextureView turns any flat kind into an array, and whole cubes into cubes."""
    flat = slot.target in _FLAT and kind.target in _FLAT
    slices = 1 if layer >= 0 else kind.slices
    fits = {
        c.TEXTURE_2D: slices == 1,
        c.TEXTURE_2D_ARRAY: True,
        c.TEXTURE_CUBE_MAP: slices == 6,
        c.TEXTURE_CUBE_MAP_ARRAY: slices % 6 == 0,
    }
    if not flat or not fits[slot.target]:
        wanted, given = _TARGET_NAMES[slot.target], _TARGET_NAMES[kind.target]
        raise ValueError(f"is {given}, the shader wants {wanted}")
