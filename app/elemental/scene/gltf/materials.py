"""Metallic-roughness materials and the extensions that change them."""

from __future__ import annotations

import numpy as np

from elemental.scene.definitions import STANDARD, builtin
from elemental.scene.definitions import UNLIT as UNLIT_MATERIAL
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import FLOAT32_MAX, Field
from elemental.scene.gltf.textures import Textures
from elemental.scene.model import AlphaMode, FloatArray, Material

ALPHA_MODES: dict[str, AlphaMode] = {"OPAQUE": "opaque", "MASK": "mask", "BLEND": "blend"}
EMISSIVE_STRENGTH = "KHR_materials_emissive_strength"
UNLIT = "KHR_materials_unlit"
TRANSMISSION = "KHR_materials_transmission"
IOR = "KHR_materials_ior"
VOLUME = "KHR_materials_volume"
GLASS = "glass"
LARGEST_IOR = 3.0
"""Of what light enters at all: diamond has 2.4."""


def read_materials(document: Document, textures: Textures) -> list[Material]:
    fields = document.root.elements("materials")
    return [_read_material(field, i, textures) for i, field in enumerate(fields)]


def _read_material(field: Field, index: int, textures: Textures) -> Material:
    empty = Field(field.report, f"{field.path}.pbrMetallicRoughness", {})
    pbr = field.find("pbrMetallicRoughness") or empty
    base_color = pbr.find("baseColorFactor")
    normal, occlusion = field.find("normalTexture"), field.find("occlusionTexture")
    material = Material(
        name=field.text_or("name", f"material{index}"),
        base_color=_clamped_color(base_color) if base_color else np.ones(4, np.float32),
        metallic=pbr.clamped_or("metallicFactor", 1.0, 0.0, 1.0),
        roughness=pbr.clamped_or("roughnessFactor", 1.0, 0.0, 1.0),
        emissive=_emissive(field),
        normal_scale=normal.number_or("scale", 1.0) if normal else 1.0,
        occlusion_strength=occlusion.clamped_or("strength", 1.0, 0.0, 1.0) if occlusion else 1.0,
        base_color_texture=textures.slot(pbr, "baseColorTexture"),
        metallic_roughness_texture=textures.slot(pbr, "metallicRoughnessTexture"),
        normal_texture=textures.slot(field, "normalTexture"),
        occlusion_texture=textures.slot(field, "occlusionTexture"),
        emissive_texture=textures.slot(field, "emissiveTexture"),
        alpha_mode=field.choice_or("alphaMode", ALPHA_MODES["OPAQUE"], ALPHA_MODES),
        alpha_cutoff=field.number_or("alphaCutoff", 0.5, 0.0),
        double_sided=field.flag("doubleSided"),
        definition=builtin(STANDARD if field.extension(UNLIT) is None else UNLIT_MATERIAL),
    )
    if material.alpha_mode == "opaque":
        material.base_color[3] = 1.0
    transmission = field.extension(TRANSMISSION)
    if transmission is not None:
        _apply_transmission(material, transmission, textures)
    ior, volume = field.extension(IOR), field.extension(VOLUME)
    if ior is not None:
        material.ior = min(max(ior.number_or("ior", 1.5, 0.0), 1.0), LARGEST_IOR)
    if volume is not None:
        _apply_volume(material, volume, textures)
    return material


def _clamped_color(field: Field) -> FloatArray:
    color = field.numbers(4)
    if color.min() < 0.0 or color.max() > 1.0:
        field.warn("is clamped to 0..1")
    return np.clip(color, 0.0, 1.0)


def _emissive(field: Field) -> FloatArray:
    """Radiance: factor times strength. Factors above 1, older than the strength, are kept."""
    factor = field.find("emissiveFactor")
    radiance = factor.numbers(3, 0.0) if factor else np.zeros(3, np.float32)
    extension = field.extension(EMISSIVE_STRENGTH)
    if extension is None:
        return radiance
    strength = extension.number_or("emissiveStrength", 1.0, 0.0)
    scaled = radiance.astype(np.float64) * strength
    if scaled.max() > FLOAT32_MAX:
        raise extension.error("the emitted radiance overflows")
    return scaled.astype(np.float32)


def _apply_transmission(material: Material, transmission: Field, textures: Textures) -> None:
    """Glass: what is behind it is seen through it."""
    factor = transmission.clamped_or("transmissionFactor", 0.0, 0.0, 1.0)
    if factor == 0.0:
        return
    material.alpha_mode = "blend"
    material.transmission = factor
    _take_picture(material, transmission, "transmissionTexture", "transmission_texture", textures)


def _apply_volume(material: Material, volume: Field, textures: Textures) -> None:
    """The body behind the surface, and what it absorbs."""
    material.thickness = volume.number_or("thicknessFactor", 0.0, 0.0)
    material.attenuation_distance = volume.number_or("attenuationDistance", 0.0, 0.0)
    color = volume.find("attenuationColor")
    if color is not None:
        material.attenuation_color = np.clip(color.numbers(3, 0.0), 0.0, 1.0)
    _take_picture(material, volume, "thicknessTexture", "thickness_texture", textures)


def _take_picture(
    material: Material, extension: Field, key: str, name: str, textures: Textures
) -> None:
    """A texture of the definition "glass", by the first uv set as it is."""
    slot = textures.slot(extension, key)
    if slot is None or material.unlit:
        return
    if slot.uv_set != 0 or not np.array_equal(slot.uv_from_uv, np.eye(2, 3)):
        extension.warn(f"{key} is read by the first texture coordinates as they are")
    material.definition = builtin(GLASS)
    material.textures = {**material.textures, name: slot}
