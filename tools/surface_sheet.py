"""Draws docs/gallery/surfaces.jpg: decals, glass, ambient occlusion and the G-buffer blur.

`PYTHONPATH=app python tools/surface_sheet.py [OUT.jpg] [--blur MODEL.gltf]`; the blur is shown on a
model of yours, or on the atrium.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.session import Viewpoint, set_stage

OUT = Path(__file__).resolve().parent.parent / "docs" / "gallery" / "surfaces.jpg"
SIZE = (480, 270)
COLUMNS = 2
QUALITY = 86


@dataclass(frozen=True)
class Shot:
    """One picture; `crop` is the middle part of it that is shown, enlarged."""

    label: str
    scene: str
    camera: str | None = None
    view: str = "final"
    settings: tuple[str, ...] = ()
    crop: tuple[float, float, float] = (0.5, 0.5, 1.0)


def shots(model: str) -> tuple[Shot, ...]:
    """The sheet, a row of two after another."""
    corner, close = (0.0, 0.75, 0.5), (0.5, 0.8, 0.34)
    return (
        Shot("decals: colour, normal, roughness, emission", "surfaces", "room"),
        Shot("on a curved wall, over an edge", "surfaces", "wall"),
        Shot("glass: clear, frosted, a bottle", "surfaces", "glass"),
        Shot("in the atrium", "atrium_glass", "glass"),
        Shot("ambient occlusion off", "atrium", settings=("ao.intensity=0",), crop=corner),
        Shot("on, intensity 1", "atrium", settings=("ao.intensity=1",), crop=corner),
        Shot("its factor", "atrium", None, "ssao", ("ao.intensity=1",)),
        Shot("its factor without cones: 2 m", "atrium", None, "ssao",
             ("ao.intensity=1", "gi.bounces=0")),
        Shot("G-buffer blur off", model, settings=("gbuffer.blur=false",), crop=close),
        Shot("on", model, settings=("gbuffer.blur=true",), crop=close),
    )  # fmt: skip


def picture(device: Device, shot: Shot) -> Image.Image:
    """The shot at SIZE."""
    stage = set_stage(shot.scene, shot.settings, Viewpoint(camera=shot.camera), SIZE)
    renderer = Renderer(device, stage.scene, stage.settings, SIZE)
    pixels = renderer.read(renderer.render(stage.camera, 0.0, 0, shot.view))[..., :3]
    device.finish()
    renderer.release()
    image = Image.fromarray(np.ascontiguousarray(pixels))
    x, y, share = shot.crop
    width, height = (round(side * share) for side in SIZE)
    left, top = round(x * (SIZE[0] - width)), round(y * (SIZE[1] - height))
    part = image.crop((left, top, left + width, top + height))
    return part.resize(SIZE, Image.Resampling.BICUBIC if share < 1.0 else Image.Resampling.NEAREST)


def pictures(device: Device, model: str) -> Iterator[tuple[str, Image.Image]]:
    """(label, picture) of the whole sheet."""
    for shot in shots(model):
        yield shot.label, picture(device, shot)


def sheet(labelled: list[tuple[str, Image.Image]]) -> Image.Image:
    """All of them, COLUMNS a row."""
    rows = -(-len(labelled) // COLUMNS)
    whole = Image.new("RGB", (SIZE[0] * COLUMNS, SIZE[1] * rows))
    draw = ImageDraw.Draw(whole)
    for number, (label, image) in enumerate(labelled):
        corner = (number % COLUMNS * SIZE[0], number // COLUMNS * SIZE[1])
        whole.paste(image, corner)
        for shift, shade in ((1, 0), (0, 255)):
            draw.text((corner[0] + 7 + shift, corner[1] + 6 + shift), label, fill=(shade,) * 3)
    return whole


def main() -> None:
    """Draw and write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", nargs="?", type=Path, default=OUT)
    parser.add_argument("--blur", default="atrium", metavar="MODEL")
    words = parser.parse_args()
    sheet(list(pictures(Device.headless(), words.blur))).save(words.out, quality=QUALITY)
    print(f"{words.out}: {words.out.stat().st_size} bytes")


if __name__ == "__main__":
    main()
