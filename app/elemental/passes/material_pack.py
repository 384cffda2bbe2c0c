"""Materials as the arrays that the GPU reads, and what they ask of draws; no GL here."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from elemental.core.layout import layouts, pack_array
from elemental.scene.definitions import VECTORS_MAX
from elemental.scene.model import AlphaMode, Material, TextureSlot

CATEGORIES: tuple[AlphaMode, ...] = ("opaque", "mask", "blend")
"""Alpha modes in the order of the draw commands."""

SLOTS = ("base_color", "metallic_roughness", "normal", "occlusion", "emissive")
"""Texture slots, in the order of SLOT_* in glsl/shared/material.glsl."""
BASE_COLOR_SLOT = 1
ALL_SLOTS = (1 << len(SLOTS)) - 1
"""MATERIAL_TEXTURES of a shader that samples every slot."""


class OwnTexture(NamedTuple):
    """A texture of a definition's own: its name, then the scene's texture or a plain one."""

    name: str
    number: int
    """In Scene.textures, -1 for a plain one."""
    plain: str
    """Of PLAIN_TEXTURES."""
    is_srgb: bool


def texture_slots(material: Material) -> tuple[TextureSlot | None, ...]:
    """A material's slots in the order of SLOTS."""
    return tuple(getattr(material, f"{slot}_texture") for slot in SLOTS)


def pack_materials(materials: Sequence[Material]) -> npt.NDArray[Any]:
    """(materials,) of the GLSL struct Material."""
    slots = [texture_slots(material) for material in materials]
    rows = np.zeros((len(materials), len(SLOTS), 2, 4), np.float32)
    for number, by_slot in enumerate(slots):
        for index, slot in enumerate(by_slot):
            if slot is not None:
                rows[number, index, :, :3] = slot.uv_from_uv

    def column(name: str) -> list[Any]:
        return [getattr(material, name) for material in materials]

    return pack_array(
        layouts().struct("Material"),
        len(materials),
        base_color=column("base_color"),
        emissive=column("emissive"),
        metallic=column("metallic"),
        roughness=column("roughness"),
        normal_scale=column("normal_scale"),
        occlusion_strength=column("occlusion_strength"),
        alpha_cutoff=column("alpha_cutoff"),
        flags=[_flags(material) for material in materials],
        texture_mask=[slot_mask(s is not None for s in by_slot) for by_slot in slots],
        uv_set_mask=[slot_mask(s is not None and s.uv_set == 1 for s in by_slot)
                     for by_slot in slots],
        uv_row_u=rows[:, :, 0],
        uv_row_v=rows[:, :, 1],
        emission_max=column("emission_max"),
        attenuation_color=column("attenuation_color"),
        attenuation_distance=column("attenuation_distance"),
        transmission=column("transmission"),
        ior=column("ior"),
        thickness=column("thickness"),
        parameters=[pack_parameters(material) for material in materials],
    )  # fmt: skip


def _flags(material: Material) -> int:
    said = {
        "DOUBLE_SIDED": material.double_sided,
        "MASK": material.alpha_mode == "mask",
        "BLEND": material.alpha_mode == "blend",
    }
    constant = layouts().constant
    return sum(int(constant(f"MATERIAL_{name}")) for name, holds in said.items() if holds)


def slot_mask(held: Iterable[bool]) -> int:
    return sum(1 << index for index, holds in enumerate(held) if holds)


def _transforms_uv(slot: TextureSlot) -> bool:
    return slot.uv_set != 0 or not np.array_equal(slot.uv_from_uv, np.eye(2, 3))


def draw_state(
    material: Material,
) -> tuple[int, bool, tuple[int, ...], bool, str, tuple[OwnTexture, ...]]:
    """What a material asks of the draws that use it.

    (place in CATEGORIES, double-sided, texture numbers by SLOTS, whether they have uv transforms,
    its definition's key, the definition's own textures).
    """
    slots = texture_slots(material)
    textures = tuple(-1 if s is None else s.texture for s in slots)
    transforms_uv = any(s is not None and _transforms_uv(s) for s in slots)
    category = CATEGORIES.index(material.alpha_mode)
    key, own = material.definition.key, own_textures(material)
    return category, material.double_sided, textures, transforms_uv, key, own


def own_textures(material: Material) -> tuple[OwnTexture, ...]:
    """The textures that the material's definition declares beyond SLOTS."""
    found = []
    for parameter in material.definition.textures:
        slot = material.textures.get(parameter.name)
        number = -1 if slot is None else slot.texture
        plain = str(material.value(parameter.name))
        found.append(OwnTexture(parameter.name, number, plain, parameter.is_srgb))
    return tuple(found)


def pack_parameters(material: Material) -> npt.NDArray[Any]:
    """(VECTORS_MAX, 4) float32: the values of the definition's own parameters."""
    floats = np.zeros(4 * VECTORS_MAX, np.float32)
    for name, place in material.definition.places().items():
        value = np.atleast_1d(np.asarray(material.value(name), np.float32))
        floats[place : place + len(value)] = value
    return floats.reshape(VECTORS_MAX, 4)


def opacity(material: Material) -> tuple[object, ...]:
    """What decides where a material lets light through."""
    slot = material.base_color_texture
    texture = None if slot is None else (slot.texture, slot.uv_set, slot.uv_from_uv.tobytes())
    shown = material.alpha_mode, material.alpha_cutoff, float(material.base_color[3]), texture
    if material.alpha_mode == "opaque" or not material.definition.own:
        return shown
    return *shown, material.definition, tuple(material.values.items()), own_textures(material)
