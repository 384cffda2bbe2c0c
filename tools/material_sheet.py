"""Draws docs/gallery/materials.jpg: the material ball under each material, and what is lit from
behind, unshadowed and shadowed. `PYTHONPATH=app python tools/material_sheet.py [OUT.jpg]`
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from PIL import Image, ImageDraw

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.scene.definitions import builtin, read_definition
from elemental.scene.load import load_scene
from elemental.scene.model import Material, Scene
from elemental.session import open_scene
from elemental.settings import Settings

OUT = Path(__file__).resolve().parent.parent / "docs" / "gallery" / "materials.jpg"
SIZE = (256, 240)
COLUMNS = 4
TIME_S = 2.0
QUALITY = 88
FROM_BEFORE = np.array([0.48, -0.64, -0.6], np.float32)
"""The way that the sun travels where something is lit from the eye's side."""


@dataclass(frozen=True)
class Subject:
    """One picture: the ball's shader and what is set of it."""

    label: str
    shader: str
    values: dict[str, object] = field(default_factory=dict)


SUBJECTS = (
    Subject("standard: a dielectric", "standard", {"base_color": [0.6, 0.03, 0.02, 1.0],
                                                   "roughness": 0.25}),
    Subject("standard: a metal", "standard", {"base_color": [1.0, 0.71, 0.29, 1.0],
                                              "metallic": 1.0, "roughness": 0.3}),
    Subject("unlit", "unlit", {"base_color": [0.1, 0.45, 0.9, 1.0]}),
    Subject("lava", "lava"),
    Subject("snow on stone", "snow", {"base_color": [0.16, 0.15, 0.14, 1.0], "roughness": 0.8}),
    Subject("subsurface: jade", "subsurface", {"base_color": [0.1, 0.34, 0.2, 1.0],
                                               "roughness": 0.3,
                                               "subsurface": [0.12, 0.5, 0.26]}),
    Subject("cloth: velvet", "cloth", {"base_color": [0.16, 0.01, 0.05, 1.0], "threads": 0.0,
                                       "sheen": [0.75, 0.25, 0.4], "fuzz": 0.55}),
    Subject("cloth: canvas", "cloth", {"base_color": [0.36, 0.3, 0.2, 1.0], "threads": 70.0,
                                       "sheen": [0.2, 0.19, 0.17]}),
)  # fmt: skip


def picture(device: Device, scene: Scene, settings: Settings, broken: bool = False) -> Image.Image:
    """The scene by its first camera. Exits where a material is broken that need not be."""
    renderer = Renderer(device, scene, settings, SIZE)
    frame = renderer.render(scene.cameras[0], TIME_S, 0)
    pixels = renderer.read(frame)[..., :3]
    device.finish()
    if renderer.problems() and not broken:
        sys.exit("\n".join(renderer.problems()))
    renderer.release()
    return Image.fromarray(np.ascontiguousarray(pixels))


def dressed(material: Material, subject: Subject) -> Material:
    """The ball's material as a subject has it."""
    worn = material.with_definition(builtin(subject.shader))
    for name, value in subject.values.items():
        worn = worn.with_value(name, value)
    return worn


def pictures(device: Device) -> Iterator[tuple[str, Image.Image]]:
    """(label, picture) of the whole sheet."""
    for subject in SUBJECTS:
        scene, settings = open_scene("material_ball", ())
        scene.materials[0] = dressed(scene.materials[0], subject)
        yield subject.label, picture(device, scene, settings)
    for label, shadowed in (("lit from behind, unshadowed", False), ("shadowed", True)):
        scene, settings = open_scene("backlit", ())
        scene.lights[0] = replace(scene.lights[0], casts_shadow=shadowed)
        yield label, picture(device, scene, settings)
    scene, settings = open_scene("backlit", ())
    flag = load_scene("backlit", default_lights=False).materials[0].with_definition(builtin("flag"))
    flag = flag.with_value("height", 0.06).with_value("wavelength", 0.25)
    scene.materials[0] = flag.with_value("base_color", (0.7, 0.06, 0.04, 1.0))
    scene.lights[0] = replace(scene.lights[0], direction=FROM_BEFORE)
    yield "flag: displaced", picture(device, scene, settings)
    scene, settings = open_scene("material_ball", ())
    with TemporaryDirectory() as folder:
        broken = Path(folder) / "broken.glsl"
        broken.write_text("/* */\nvoid material(inout Surface s, MaterialInput m) {}\n")
        worn = scene.materials[0].with_definition(read_definition(broken))
        scene.materials[0] = worn
        yield "one that does not compile", picture(device, scene, settings, broken=True)


def sheet(labelled: list[tuple[str, Image.Image]]) -> Image.Image:
    """All of them, COLUMNS a row."""
    rows = -(-len(labelled) // COLUMNS)
    whole = Image.new("RGB", (SIZE[0] * COLUMNS, SIZE[1] * rows))
    draw = ImageDraw.Draw(whole)
    for number, (label, image) in enumerate(labelled):
        corner = (number % COLUMNS * SIZE[0], number // COLUMNS * SIZE[1])
        whole.paste(image, corner)
        draw.text((corner[0] + 7, corner[1] + 7), label, fill=(0, 0, 0))
        draw.text((corner[0] + 6, corner[1] + 6), label, fill=(255, 255, 255))
    return whole


def main() -> None:
    """Draw and write it."""
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else OUT
    sheet(list(pictures(Device.headless()))).save(out, quality=QUALITY)
    print(f"{out}: {out.stat().st_size} bytes")


if __name__ == "__main__":
    main()
