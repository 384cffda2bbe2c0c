"""Materials and their textures, as glTF has them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np

from elemental.scene.arrays import ByteArray, FloatArray

Wrap: TypeAlias = Literal["repeat", "clamp", "mirror"]
AlphaMode: TypeAlias = Literal["opaque", "mask", "blend"]


@dataclass
class Texture:
    """An image with its sampler. `pixels` is (H, W, 4) uint8 as stored: row 0 is v = 0."""

    name: str
    pixels: ByteArray
    wrap_u: Wrap = "repeat"
    wrap_v: Wrap = "repeat"
    nearest: bool = False


@dataclass
class TextureSlot:
    """A material's use of `Scene.textures[texture]`.

    `uv_from_uv` is (2, 3) float32: texture coordinate = uv_from_uv @ (u, v, 1).
    """

    texture: int
    uv_set: Literal[0, 1] = 0
    uv_from_uv: FloatArray = field(default_factory=lambda: np.eye(2, 3, dtype=np.float32))


@dataclass
class Material:
    """glTF's metallic-roughness material.

    `base_color` (4,) float32 linear with opacity; `emissive` (3,) float32 linear radiance in nit,
    strength included. Textures multiply their factors: base colour and emissive textures are sRGB
    encoded, the others linear (metallic in B, roughness in G, occlusion in R).
    """

    name: str
    base_color: FloatArray = field(default_factory=lambda: np.ones(4, np.float32))
    metallic: float = 1.0
    roughness: float = 1.0
    emissive: FloatArray = field(default_factory=lambda: np.zeros(3, np.float32))
    normal_scale: float = 1.0
    occlusion_strength: float = 1.0
    base_color_texture: TextureSlot | None = None
    metallic_roughness_texture: TextureSlot | None = None
    normal_texture: TextureSlot | None = None
    occlusion_texture: TextureSlot | None = None
    emissive_texture: TextureSlot | None = None
    alpha_mode: AlphaMode = "opaque"
    alpha_cutoff: float = 0.5
    double_sided: bool = False
    unlit: bool = False

    @property
    def emits(self) -> bool:
        """Whether any radiance leaves the surface by itself."""
        return bool(self.emissive.max() > 0.0)
