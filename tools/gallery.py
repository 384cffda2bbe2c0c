"""Draws the large pictures of docs/gallery: `PYTHONPATH=app python tools/gallery.py [NAME…]`.

atrium, glass, light_masks: one scene each, 1280x720; lights: a sheet of four. The other sheets have
tools of their own: material_sheet.py, surface_sheet.py, post_sheet.py, volume_sheet.py.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from elemental.gpu.device import Device
from shots import COLUMNS, Shot, sheet

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "gallery"
SIZE = (1280, 720)
QUALITY = 90

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


def main() -> None:
    """Draw and write those that the command line names, or all."""
    parser = argparse.ArgumentParser(description="Draws the large pictures of docs/gallery.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(PICTURES))
    device = Device.headless()
    for name in parser.parse_args().names or PICTURES:
        shots = PICTURES[name]
        size = SIZE if len(shots) == 1 else (SIZE[0] // COLUMNS, SIZE[1] // COLUMNS)
        out = FOLDER / f"{name}.jpg"
        sheet(device, shots, size).save(out, quality=QUALITY)
        print(f"{out}: {out.stat().st_size} bytes", flush=True)


if __name__ == "__main__":
    main()
