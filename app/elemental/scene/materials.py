"""Materials and their textures: what glTF has, and what an artist's definition adds."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal, TypeAlias

import numpy as np

from elemental.core.errors import InputError
from elemental.scene.arrays import ByteArray, FloatArray
from elemental.scene.definitions import COMMON_PARAMETERS, STANDARD, MaterialDefinition, builtin
from elemental.scene.parameters import ParameterValue

Wrap: TypeAlias = Literal["repeat", "clamp", "mirror"]
AlphaMode: TypeAlias = Literal["opaque", "mask", "blend"]


@dataclass
class Texture:
    """An image with its sampler. `pixels` is (H, W, 4) uint8 as stored: row 0 is v = 0.

    `file` is the image file that a scene file or the panel named; None for a model's own image.
    """

    name: str
    pixels: ByteArray
    wrap_u: Wrap = "repeat"
    wrap_v: Wrap = "repeat"
    nearest: bool = False
    file: Path | None = None


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
    """A material: glTF's metallic-roughness values, and what its `definition` makes of them.

    `base_color` (4,) float32 linear with opacity; `emissive` (3,) float32 linear radiance in nit,
    strength included. Textures multiply their factors: base colour and emissive textures are sRGB
    encoded, the others linear (metallic in B, roughness in G, occlusion in R).

    Light passes a share of `transmission` through what is blended, `thickness` (local units; 0 for
    a thin wall) of a body of index of refraction `ior`, of which `attenuation_color` (3,) is left
    after `attenuation_distance` m (0: of all ways).

    `values` are those of the definition's own parameters that are not at their default, `textures`
    its own textures that are not plain.
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
    transmission: float = 0.0
    ior: float = 1.5
    thickness: float = 0.0
    attenuation_color: FloatArray = field(default_factory=lambda: np.ones(3, np.float32))
    attenuation_distance: float = 0.0
    definition: MaterialDefinition = field(default_factory=lambda: builtin(STANDARD))
    values: dict[str, ParameterValue] = field(default_factory=dict)
    textures: dict[str, TextureSlot] = field(default_factory=dict)

    @property
    def is_standard(self) -> bool:
        """Whether it is glTF's own material, lit."""
        return self.definition.is_standard

    @property
    def unlit(self) -> bool:
        """Whether it shows its base colour, whatever the light (KHR_materials_unlit)."""
        return self.definition.is_unlit

    @property
    def transmits(self) -> bool:
        """Whether what is behind it is seen through it, bent and tinted."""
        return self.alpha_mode == "blend" and self.transmission > 0.0

    @property
    def emission_max(self) -> float:
        """Bound of the radiance that leaves the surface by itself, nit; what is more is cut."""
        if not self.definition.emits:
            return 0.0
        return math.prod(max(_numbers(self.value(name))) for name in self.definition.emits)

    @property
    def emits(self) -> bool:
        """Whether any radiance leaves the surface by itself."""
        return self.emission_max > 0.0

    def value(self, name: str) -> ParameterValue:
        """A parameter that is no texture, as it is now."""
        if name in COMMON_PARAMETERS:
            held = getattr(self, name)
            if isinstance(held, np.ndarray):
                return tuple(float(part) for part in held)
            return float(held)
        parameter = self.definition.parameter(name)
        assert parameter is not None, f"{self.definition.name} has no parameter {name}"
        return self.values.get(name, parameter.default)

    def with_definition(self, definition: MaterialDefinition) -> Material:
        """This material by another definition, with those values that it knows."""
        values = {}
        for name, value in self.values.items():
            try:
                values[name] = definition.check_value(name, value)
            except InputError:
                continue
        names = {p.name for p in definition.textures}
        textures = {name: slot for name, slot in self.textures.items() if name in names}
        return replace(self, definition=definition, values=values, textures=textures)

    def with_value(self, name: str, value: object) -> Material:
        """This material with another value of a parameter that is no texture.

        Raises InputError(definition, name, reason) for a name or a value that can't be.
        """
        checked = self.definition.check_value(name, value)
        if name not in COMMON_PARAMETERS:
            return replace(self, values={**self.values, name: checked})
        held = np.array(checked, np.float32) if isinstance(checked, tuple) else checked
        changed: dict[str, object] = {name: held}
        if name == "transmission" and checked and self.alpha_mode == "opaque":
            changed["alpha_mode"] = "blend"
        return replace(self, **changed)  # type: ignore[arg-type]  # the names are its fields'

    def texture(self, name: str) -> TextureSlot | None:
        """The image of one of its texture parameters; None where that is plain."""
        slot: TextureSlot | None = (
            getattr(self, name) if name in COMMON_PARAMETERS else self.textures.get(name)
        )
        return slot

    def with_image(self, name: str, texture: int) -> Material:
        """This material with `Scene.textures[texture]` for one of its texture parameters.

        It lies on the surface as the image before it did.
        """
        before = self.texture(name)
        if before is None:
            return self.with_slot(name, TextureSlot(texture))
        return self.with_slot(name, replace(before, texture=texture))

    def without_image(self, name: str) -> Material:
        """This material with nothing for one of its texture parameters: it is plain."""
        bare = self.with_slot(name, None)
        return replace(bare, values={k: v for k, v in bare.values.items() if k != name})

    def with_slot(self, name: str, slot: TextureSlot | None) -> Material:
        """This material with another slot for one of its texture parameters."""
        if name not in COMMON_PARAMETERS:
            others = {k: v for k, v in self.textures.items() if k != name}
            return replace(self, textures=others if slot is None else {**others, name: slot})
        changed: dict[str, object] = {name: slot}
        return replace(self, **changed)  # type: ignore[arg-type]  # the names are its fields'


def _numbers(value: ParameterValue) -> tuple[float, ...]:
    """The numbers of a value, of an rgba its colour's."""
    if isinstance(value, tuple):
        return value[:3]
    assert not isinstance(value, str)
    return (float(value),)
