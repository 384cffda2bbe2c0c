"""The atrium's materials and the images that they use."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from atrium import textures
from atrium.glb import GlbWriter
from atrium.mesh import F64

RGB = tuple[float, float, float]
WHITE: RGB = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Material:
    """A metallic-roughness material; colours are linear, `glow` is radiance."""

    color: RGB = WHITE
    roughness: float = 0.85
    metallic: float = 0.0
    glow: RGB = (0.0, 0.0, 0.0)
    image: str = ""  # stem of its images: IMAGE, IMAGE_normal, IMAGE_roughness, IMAGE_glow
    normal_scale: float = 1.0
    metres_per_tile: float = 2.0
    crease_degrees: float = 38.0
    double_sided: bool = False


CLOTH = Material(
    roughness=0.9, image="damask", metres_per_tile=1.6, crease_degrees=180.0, double_sided=True
)


def _cloth(color: RGB) -> Material:
    return Material(
        color,
        CLOTH.roughness,
        image=CLOTH.image,
        metres_per_tile=CLOTH.metres_per_tile,
        crease_degrees=CLOTH.crease_degrees,
        double_sided=True,
    )


MATERIALS: dict[str, Material] = {
    "limestone": Material((0.78, 0.69, 0.56), 0.82, image="stone", normal_scale=0.7),
    "red_stone": Material((0.46, 0.17, 0.11), 0.7, image="stone", normal_scale=0.7),
    "dark_stone": Material((0.20, 0.19, 0.19), 0.45, image="stone", normal_scale=0.7),
    "plaster": Material((0.80, 0.74, 0.64), 0.9, image="stone", normal_scale=0.4),
    "ashlar": Material((0.74, 0.60, 0.43), 0.88, image="ashlar", metres_per_tile=2.8),
    "terracotta_floor": Material((0.46, 0.21, 0.12), 0.55, image="tiles", metres_per_tile=2.1),
    "marble_floor": Material(WHITE, 1.0, image="marble", metres_per_tile=2.8),
    "wood": Material((0.21, 0.115, 0.06), 0.7, image="wood", metres_per_tile=1.0),
    "roof_tiles": Material((0.50, 0.21, 0.11), 0.85, image="roof", metres_per_tile=1.9),
    "pottery": Material((0.50, 0.22, 0.12), 0.8, image="stone", normal_scale=0.7),
    "bronze": Material((0.62, 0.42, 0.22), 0.32, 1.0),
    "leaves": Material((0.11, 0.26, 0.05), 0.7, double_sided=True),
    "leaves_dark": Material((0.035, 0.075, 0.02), 0.9),
    "cloth_red": _cloth((0.62, 0.035, 0.025)),
    "cloth_green": _cloth((0.045, 0.36, 0.07)),
    "cloth_blue": _cloth((0.03, 0.10, 0.55)),
    "melt": Material((0.02, 0.02, 0.02), 0.6, glow=(12.0, 4.6, 1.1), image="melt"),
    "crystal": Material((0.10, 0.30, 0.35), 0.15, glow=(0.3, 2.0, 2.6), crease_degrees=5.0),
    "lantern": Material((0.8, 0.6, 0.3), 0.6, glow=(6.0, 3.4, 1.3)),
}


def _images() -> dict[str, Callable[[], bytes]]:
    """Every image by name, made when asked for."""

    def grey(value: F64, mean: float = 1.0) -> bytes:
        return textures.color_map(np.repeat(value[..., None] / mean, 3, axis=-1))

    def surface(
        name: str, maker: Callable[[], tuple[F64, F64]], head_room: float
    ) -> dict[str, Callable[[], bytes]]:
        metres = next(m.metres_per_tile for m in MATERIALS.values() if m.image == name)
        return {
            name: lambda: textures.color_map(textures.tint(WHITE, maker()[0]) / head_room),
            f"{name}_normal": lambda: textures.normal_map(maker()[1], metres),
        }

    return {
        **surface("stone", textures.stone, HEAD_ROOM["stone"]),
        **surface("ashlar", textures.ashlar, HEAD_ROOM["ashlar"]),
        **surface("tiles", textures.tiles, HEAD_ROOM["tiles"]),
        **surface("wood", textures.wood, HEAD_ROOM["wood"]),
        **surface("roof", textures.roof, HEAD_ROOM["roof"]),
        "marble": lambda: textures.color_map(textures.marble_floor()[0]),
        "marble_roughness": lambda: textures.roughness_map(textures.marble_floor()[1]),
        "damask": lambda: grey(textures.damask(), HEAD_ROOM["damask"]),
        "melt_glow": lambda: textures.color_map(textures.melt()),
    }


HEAD_ROOM = {"stone": 1.2, "ashlar": 1.25, "tiles": 1.35, "wood": 1.5, "roof": 1.35, "damask": 1.3}
"""Relative textures vary about 1; they are stored divided by this and the colour makes it good."""


class MaterialWriter:
    """Writes materials and images into a glb when they are first used."""

    def __init__(self, glb: GlbWriter) -> None:
        self._glb = glb
        self._images = _images()
        self._textures: dict[str, int] = {}
        self._materials: dict[str, int] = {}

    def index(self, name: str) -> int:
        """The glTF index of one of MATERIALS."""
        if name not in self._materials:
            self._materials[name] = self._glb.add("materials", self._entry(name, MATERIALS[name]))
        return self._materials[name]

    def _slot(self, image: str) -> dict[str, Any] | None:
        if image not in self._images:
            return None
        if image not in self._textures:
            self._textures[image] = self._glb.texture(image, self._images[image]())
        return {"index": self._textures[image]}

    def _entry(self, name: str, m: Material) -> dict[str, Any]:
        gain = HEAD_ROOM.get(m.image, 1.0)
        pbr: dict[str, Any] = {
            "baseColorFactor": [*(round(min(c * gain, 1.0), 5) for c in m.color), 1.0],
            "metallicFactor": m.metallic,
            "roughnessFactor": m.roughness,
        }
        entry: dict[str, Any] = {"name": name, "pbrMetallicRoughness": pbr}
        if slot := self._slot(m.image):
            pbr["baseColorTexture"] = slot
        if slot := self._slot(f"{m.image}_roughness"):
            pbr["metallicRoughnessTexture"] = slot
            pbr["metallicFactor"] = 1.0
        if slot := self._slot(f"{m.image}_normal"):
            entry["normalTexture"] = {**slot, "scale": m.normal_scale}
        strength = max(m.glow)
        if strength > 0.0:
            entry["emissiveFactor"] = [round(c / strength, 5) for c in m.glow]
            entry["extensions"] = {
                "KHR_materials_emissive_strength": {"emissiveStrength": strength}
            }
            if slot := self._slot(f"{m.image}_glow"):
                entry["emissiveTexture"] = slot
        if m.double_sided:
            entry["doubleSided"] = True
        return entry
