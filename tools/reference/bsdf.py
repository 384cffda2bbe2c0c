"""Our metallic-roughness materials as mitsuba BSDFs.

Ours (glsl/lib/material.glsl): a Lambertian lobe base·(1 - metallic) plus a specular lobe whose
reflectance at normal incidence is mix(0.04, base, metallic), added without taking energy from the
first but where both would return more than arrives. Mitsuba has no sum of two BSDFs, so a
`blendbsdf` of weight 1/2 mixes both lobes at twice their reflectance, which its importance sampling
handles without bias:

- `diffuse` with 2·base·(1 - metallic)
- `blendbsdf` over metallic of
  - `roughconductor`, GGX, eta 1.5, k 0: the Fresnel reflectance of glass (0.04 at 0 degrees)
  - `roughconductor`, GGX, no Fresnel term, 2·base: metals without their edge brightening

Glass is a `thindielectric`, of a body a `dielectric` or `roughdielectric`, which transmit wholly,
tinted by the base colour's factor once: by its root at each of a body's two surfaces. What a body
absorbs is a medium inside (`interior`), so its mesh has to be closed.

alpha = roughness^2. Above them `normalmap`, `mask` (alpha modes) and `twosided`. Differences left:
vertex colours multiply constants only; one uv set a material; our occlusion textures, which darken
ambient light only, have no counterpart in a path tracer.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mitsuba as mi
import numpy as np
from PIL import Image

from elemental.scene.model import FloatArray, Material, Scene, TextureSlot

Entry = dict[str, Any]

ALPHA_MIN = 0.002
"""Smoothest GGX that mitsuba samples without noise; a mirror to the eye."""


def srgb_to_linear(encoded: FloatArray) -> FloatArray:
    """IEC 61966-2-1 decoding of values 0..1."""
    low, high = encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4
    return np.where(encoded <= 0.04045, low, high).astype(np.float32)


def bitmap(pixels: FloatArray, slot: TextureSlot | None, scene: Scene) -> Entry:
    """Linear values (H, W, C) as a texture that is used as it is, values above 1 included."""
    entry: Entry = {
        "type": "bitmap",
        "bitmap": mi.Bitmap(np.ascontiguousarray(pixels)),
        "raw": True,
    }
    if slot is not None:
        texture = scene.textures[slot.texture]
        entry["wrap_mode"] = {"mirror": "mirror", "clamp": "clamp"}.get(texture.wrap_u, "repeat")
        entry["filter_type"] = "nearest" if texture.nearest else "bilinear"
        if not np.allclose(slot.uv_from_uv, np.eye(2, 3)):
            matrix = np.eye(3)
            matrix[:2] = slot.uv_from_uv
            entry["to_uv"] = mi.ScalarTransform3f(matrix.tolist())
    return entry


@dataclass(frozen=True)
class Maps:
    """A material's values, (H, W, C) float32, H = W = 1 where no texture is."""

    base: FloatArray
    opacity: FloatArray
    metallic: FloatArray
    roughness: FloatArray
    slot: TextureSlot | None


class MaterialConverter:
    """Makes mitsuba entries of one scene's materials."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def uv_set(self, material: Material) -> int:
        """The uv set that the material reads: its first texture's."""
        return next((slot.uv_set for slot in _slots(material)), 0)

    def _pixels(self, slot: TextureSlot) -> FloatArray:
        return self._scene.textures[slot.texture].pixels.astype(np.float32) / np.float32(255.0)

    def _maps(self, m: Material, vertex_color: FloatArray) -> Maps:
        base_slot, rough_slot = m.base_color_texture, m.metallic_roughness_texture
        factor = m.base_color * vertex_color
        base, opacity = factor[None, None, :3], factor[None, None, 3:]
        if base_slot is not None:
            pixels = self._pixels(base_slot)
            base = srgb_to_linear(pixels[..., :3]) * base
            opacity = pixels[..., 3:] * opacity
        metallic = np.full((1, 1, 1), m.metallic, np.float32)
        roughness = np.full((1, 1, 1), m.roughness, np.float32)
        if rough_slot is not None:
            pixels = self._pixels(rough_slot)
            if base.shape[:2] not in {(1, 1), pixels.shape[:2]}:
                pixels = _resized(pixels, base.shape[:2])
            roughness, metallic = pixels[..., 1:2] * m.roughness, pixels[..., 2:3] * m.metallic
        return Maps(base, opacity, metallic, roughness, base_slot or rough_slot)

    def bsdf(self, m: Material, vertex_color: FloatArray) -> Entry:
        """The whole BSDF; `vertex_color` (4,) linear is the mesh's mean."""
        maps = self._maps(m, vertex_color)
        if m.unlit:
            return {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}}
        if m.transmits:
            return _glass(m)
        entry = self._lobes(maps)
        if m.normal_texture is not None:
            entry = {
                "type": "normalmap",
                "normalmap": bitmap(self._normals(m), m.normal_texture, self._scene),
                "bsdf": entry,
            }
        entry = {"type": "twosided", "bsdf": entry}
        if m.alpha_mode != "opaque":
            opacity = maps.opacity
            if m.alpha_mode == "mask":
                opacity = (opacity >= m.alpha_cutoff).astype(np.float32)
            opacity_entry = bitmap(opacity, maps.slot, self._scene)
            entry = {"type": "mask", "opacity": opacity_entry, "bsdf": entry}
        return entry

    def _lobes(self, maps: Maps) -> Entry:
        def texture(values: FloatArray) -> Entry:
            return bitmap(values.astype(np.float32), maps.slot, self._scene)

        alpha = texture(np.maximum(maps.roughness**2, ALPHA_MIN))
        diffuse: Entry = {
            "type": "diffuse",
            "reflectance": texture(2.0 * maps.base * (1.0 - maps.metallic)),
        }
        coat: Entry = {
            "type": "roughconductor",
            "distribution": "ggx",
            "alpha": alpha,
            "eta": {"type": "rgb", "value": 1.5},
            "k": {"type": "rgb", "value": 0.0},
            "specular_reflectance": texture(np.full((1, 1, 3), 2.0, np.float32)),
        }
        metal: Entry = {
            "type": "roughconductor",
            "distribution": "ggx",
            "alpha": alpha,
            "material": "none",
            "specular_reflectance": texture(2.0 * maps.base),
        }
        specular = coat
        if maps.metallic.max() > 0.0:
            weight = texture(maps.metallic)
            specular = {"type": "blendbsdf", "weight": weight, "coat": coat, "metal": metal}
        return {"type": "blendbsdf", "weight": 0.5, "diffuse": diffuse, "specular": specular}

    def _normals(self, m: Material) -> FloatArray:
        """The normal map with the material's scale applied, encoded as mitsuba reads it."""
        assert m.normal_texture is not None
        normal = (self._pixels(m.normal_texture)[..., :3] * 255.0 - 128.0) / 127.0
        normal[..., :2] *= m.normal_scale
        normal[..., 2] = np.maximum(normal[..., 2], 1e-3)
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        return np.asarray(normal * 0.5 + 0.5, dtype=np.float32)

    def radiance(self, m: Material) -> tuple[FloatArray, TextureSlot | None]:
        """What an emissive or unlit material sends out, (H, W, 3) nit, and how it is read."""
        if m.unlit:
            maps = self._maps(m, np.ones(4, np.float32))
            return maps.base.astype(np.float32), maps.slot
        glow = m.emissive[None, None].astype(np.float32)
        if m.emissive_texture is not None:
            glow = glow * srgb_to_linear(self._pixels(m.emissive_texture)[..., :3])
        return glow, m.emissive_texture


def _glass(m: Material) -> Entry:
    tint = m.base_color[:3] if m.thickness == 0.0 else np.sqrt(m.base_color[:3])
    entry: Entry = {
        "type": "dielectric" if m.thickness > 0.0 else "thindielectric",
        "int_ior": m.ior,
        "specular_transmittance": {"type": "rgb", "value": tint.tolist()},
    }
    if m.roughness > 0.0 and m.thickness > 0.0:
        entry |= {"type": "roughdielectric", "distribution": "ggx", "alpha": m.roughness**2}
    return entry


def interior(m: Material) -> Entry | None:
    """The medium inside a body of glass that absorbs [KHR_materials_volume]; None of others."""
    if not m.transmits or m.thickness == 0.0 or m.attenuation_distance == 0.0:
        return None
    absorbs = -np.log(np.maximum(m.attenuation_color, 1e-4)) / m.attenuation_distance
    density = float(absorbs.max())
    if density == 0.0:
        return None
    return {
        "type": "homogeneous",
        "albedo": 0.0,
        "sigma_t": {"type": "rgb", "value": (absorbs / density).tolist()},
        "scale": density,
    }


def _slots(m: Material) -> list[TextureSlot]:
    slots = (
        m.base_color_texture,
        m.metallic_roughness_texture,
        m.normal_texture,
        m.emissive_texture,
    )
    return [slot for slot in slots if slot is not None]


def _resized(pixels: FloatArray, shape: tuple[int, int]) -> FloatArray:
    """(H, W, C) resampled bilinearly to another (H, W)."""
    planes = [
        np.asarray(Image.fromarray(pixels[..., c]).resize(shape[::-1], Image.Resampling.BILINEAR))
        for c in range(pixels.shape[2])
    ]
    return np.stack(planes, axis=-1)
