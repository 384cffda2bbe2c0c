"""From the GLSL names of a pass to units, views and barrier bits; no GL calls."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from elemental.gpu import gl as c
from elemental.gpu.program import IMAGE, SAMPLER, STORAGE_BLOCK, UNIFORM_BLOCK, Program, Slot
from elemental.gpu.refs import (
    BufferHandle,
    Layer,
    Mip,
    Ref,
    Sampled,
    SamplerKey,
    TextureHandle,
    TextureRef,
)
from elemental.gpu.resources import Buffer, Texture, TextureDesc

Params = Mapping[str, npt.NDArray[np.void]]


class GraphError(Exception):
    """A pass that can't be recorded; the message names the shader and the name in question."""


class SamplerBinding(NamedTuple):
    """A texture unit of a pass."""

    unit: int
    target: int
    resource: int
    level: int
    levels: int
    layer: int
    stencil: bool
    sampler: SamplerKey


class ImageBinding(NamedTuple):
    """An image unit of a pass."""

    unit: int
    target: int
    resource: int
    level: int
    layered: bool
    layer: int
    access: int
    format: int


class BlockBinding(NamedTuple):
    """A storage block, or a uniform block filled from a buffer."""

    target: int
    unit: int
    resource: int


Binding = SamplerBinding | ImageBinding | BlockBinding


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


def bind(
    slot: Slot,
    ref: Ref,
    index_of: Callable[[Texture | TextureHandle | Buffer | BufferHandle], int],
    program: Program,
) -> tuple[list[Binding], list[int], int]:
    """(bindings, resource indices, barrier bit) of ``ref`` at ``slot``."""
    if slot.kind == SAMPLER:
        refs = ref if isinstance(ref, (list, tuple)) else (ref,)
        if slot.active and len(refs) != slot.count:
            raise GraphError(
                f"{program.shader!r}: {slot.name} takes {slot.count} textures, {len(refs)} given"
            )
        bindings: list[Binding] = [
            _sampler(slot, element, offset, index_of, program)
            for offset, element in enumerate(refs)
        ]
        return bindings, [item.resource for item in bindings], c.TEXTURE_FETCH_BARRIER
    if slot.kind == IMAGE:
        image = _image(slot, ref, index_of, program)
        return [image], [image.resource], c.SHADER_IMAGE_ACCESS_BARRIER
    if not isinstance(ref, (Buffer, BufferHandle)):
        raise GraphError(f"{program.shader!r}: {slot.name} is a block, {ref!r} is no buffer")
    index = index_of(ref)
    if slot.kind == STORAGE_BLOCK:
        limit = program.storage_limit
        if ref.nbytes > limit:
            raise GraphError(
                f"{program.shader!r}: {slot.name}: {ref.name} has {ref.nbytes} bytes, "
                f"this driver binds at most {limit}"
            )
        block = BlockBinding(c.SHADER_STORAGE_BUFFER, slot.unit, index)
        return [block], [index], c.SHADER_STORAGE_BARRIER
    return [BlockBinding(c.UNIFORM_BUFFER, slot.unit, index)], [index], c.UNIFORM_BARRIER


def look_at(
    ref: object, slot: Slot, program: Program
) -> tuple[Texture | TextureHandle, int, int, int]:
    """(texture, first level, levels, layer or -1) of a texture reference."""
    if isinstance(ref, (Texture, TextureHandle)):
        return ref, 0, ref.desc.mips, -1
    if isinstance(ref, Mip):
        texture, level, layer = ref.texture, ref.level, -1
    elif isinstance(ref, Layer):
        texture, level, layer = ref.texture, ref.level, ref.layer
    else:
        raise GraphError(f"{program.shader!r}: {slot.name} needs a texture, not {ref!r}")
    desc = texture.desc
    if not 0 <= level < desc.mips or not -1 <= layer < desc.slices:
        raise GraphError(
            f"{program.shader!r}: {slot.name}: {texture.name} has no level {level}, layer {layer}"
        )
    return texture, level, 1, layer


def _sampler(
    slot: Slot,
    ref: TextureRef,
    offset: int,
    index_of: Callable[[Texture | TextureHandle | Buffer | BufferHandle], int],
    program: Program,
) -> SamplerBinding:
    stencil = False
    if isinstance(ref, Sampled):
        texture, level, levels, layer = look_at(ref.texture, slot, program)
        default = "linear" if texture.desc.format.filterable or ref.compare else "nearest"
        key = (ref.filter or default, ref.wrap, ref.compare, ref.border, ref.anisotropy)
        stencil = ref.stencil
        if slot.active and slot.shadow != ref.compare:
            wanted = "with" if slot.shadow else "without"
            raise GraphError(f"{program.shader!r}: {slot.name} is sampled {wanted} compare")
    else:
        texture, level, levels, layer = look_at(ref, slot, program)
        linear = texture.desc.format.filterable or slot.shadow
        key = ("linear" if linear else "nearest", "clamp", slot.shadow, 0.0, 1.0)
    target = c.TEXTURE_2D if layer >= 0 else texture.desc.target
    if slot.active and target != slot.target:
        _check_viewable(slot, texture.desc, texture.name, layer, program)
        target = slot.target
    if layer >= 0 and texture.desc.target == c.TEXTURE_3D:
        raise GraphError(f"{program.shader!r}: {slot.name}: a slice of 3D can't be sampled alone")
    index = index_of(texture)
    return SamplerBinding(slot.unit + offset, target, index, level, levels, layer, stencil, key)


def _image(
    slot: Slot,
    ref: Ref,
    index_of: Callable[[Texture | TextureHandle | Buffer | BufferHandle], int],
    program: Program,
) -> ImageBinding:
    texture, level, _, layer = look_at(ref, slot, program)
    desc = texture.desc
    layered = layer < 0 and desc.target != c.TEXTURE_2D
    target = desc.target
    if layer < 0 and slot.active and slot.target != desc.target:
        _check_viewable(slot, desc, texture.name, layer, program)
        target = slot.target
    fmt = slot.image_format or desc.format.internal
    index = index_of(texture)
    first = max(layer, 0)
    return ImageBinding(slot.unit, target, index, level, layered, first, slot.access, fmt)


_TARGET_NAMES = {
    c.TEXTURE_2D: "2D", c.TEXTURE_3D: "3D", c.TEXTURE_2D_ARRAY: "2DArray",
    c.TEXTURE_CUBE_MAP: "Cube", c.TEXTURE_CUBE_MAP_ARRAY: "CubeArray",
}  # fmt: skip
_FLAT = {c.TEXTURE_2D, c.TEXTURE_2D_ARRAY, c.TEXTURE_CUBE_MAP, c.TEXTURE_CUBE_MAP_ARRAY}


def _check_viewable(slot: Slot, desc: TextureDesc, name: str, layer: int, program: Program) -> None:
    """glTextureView turns any flat kind into an array, and whole cubes into cubes."""
    flat = slot.target in _FLAT and desc.target in _FLAT
    slices = 1 if layer >= 0 else desc.slices
    fits = {
        c.TEXTURE_2D: slices == 1,
        c.TEXTURE_2D_ARRAY: True,
        c.TEXTURE_CUBE_MAP: slices == 6,
        c.TEXTURE_CUBE_MAP_ARRAY: slices % 6 == 0,
    }
    if not flat or not fits[slot.target]:
        raise GraphError(
            f"{program.shader!r}: {slot.name} is {_TARGET_NAMES[slot.target]}, "
            f"{name} is {_TARGET_NAMES[desc.target]}"
        )


def check_block_size(slot: Slot, values: npt.NDArray[np.void], program: Program) -> None:
    """Raise GraphError where a packed array does not fill the uniform block."""
    if slot.active and -(-slot.size // 16) != -(-values.nbytes // 16):
        raise GraphError(
            f"{program.shader!r}: block {slot.name} has {slot.size} bytes, {values.nbytes} given"
        )
