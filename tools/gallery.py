"""Draws the large pictures of docs/gallery: `PYTHONPATH=app python tools/gallery.py [NAME…]`.

atrium, glass, light_masks: one scene each, 1280x720; lights: a sheet of four. The other sheets have
tools of their own: material_sheet.py, surface_sheet.py, post_sheet.py, volume_sheet.py.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.session import Viewpoint, set_stage

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "gallery"
SIZE = (1280, 720)
QUALITY = 90
COLUMNS = 2


@dataclass(frozen=True)
class Shot:
    """A scene by one of its cameras, or its first."""

    scene: str
    camera: str | None = None
    settings: tuple[str, ...] = ()


PICTURES = {
    "atrium": (Shot("atrium", "fountain", ("gi.resolution=256",)),),
    "glass": (Shot("atrium_glass"),),
    "light_masks": (Shot("light_masks"),),
    "lights": (
        Shot("many_lights", "courtyard"),
        Shot("many_lights", "arcade"),
        Shot("one_lamp"),
        Shot("light_sizes"),
    ),
}
"""File name without its suffix -> its pictures."""


def picture(device: Device, shot: Shot, size: tuple[int, int]) -> Image.Image:
    """The shot at a size, (width, height) px."""
    stage = set_stage(shot.scene, shot.settings, Viewpoint(shot.camera), size)
    renderer = Renderer(device, stage.scene, stage.settings, size)
    frame = renderer.render(stage.camera_at(0.0), 0.0, 0)
    pixels = renderer.read(frame)[..., :3]
    device.finish()
    renderer.release()
    return Image.fromarray(np.ascontiguousarray(pixels))


def sheet(device: Device, shots: tuple[Shot, ...]) -> Image.Image:
    """One picture as it is, several COLUMNS a row."""
    if len(shots) == 1:
        return picture(device, shots[0], SIZE)
    width, height = SIZE[0] // COLUMNS, SIZE[1] // COLUMNS
    whole = Image.new("RGB", (width * COLUMNS, height * -(-len(shots) // COLUMNS)))
    for number, shot in enumerate(shots):
        place = (number % COLUMNS * width, number // COLUMNS * height)
        whole.paste(picture(device, shot, (width, height)), place)
    return whole


def main() -> None:
    """Draw and write those that the command line names, or all."""
    parser = argparse.ArgumentParser(description="Draws the large pictures of docs/gallery.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(PICTURES))
    device = Device.headless()
    for name in parser.parse_args().names or PICTURES:
        out = FOLDER / f"{name}.jpg"
        sheet(device, PICTURES[name]).save(out, quality=QUALITY)
        print(f"{out}: {out.stat().st_size} bytes", flush=True)


if __name__ == "__main__":
    main()
