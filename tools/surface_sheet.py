"""Draws docs/gallery/surfaces.jpg: decals, glass, ambient occlusion and the G-buffer blur.

`PYTHONPATH=app python tools/surface_sheet.py [OUT.jpg] [--blur MODEL.gltf]`; the blur is shown on a
model of yours, or on the atrium.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from elemental.gpu.device import Device
from shots import Shot, sheet

OUT = Path(__file__).resolve().parent.parent / "docs" / "gallery" / "surfaces.jpg"
SIZE = (480, 270)
QUALITY = 86
CORNER, CLOSE = (0.0, 0.75, 0.5), (0.5, 0.8, 0.34)
"""Parts of pictures, as `Shot.crop` has them."""


def shots(model: str) -> tuple[Shot, ...]:
    """The sheet, a row of two after another."""
    ao = ("ao.intensity=1",)
    return (
        Shot("surfaces", "room", label="decals: colour, normal, roughness, emission"),
        Shot("surfaces", "wall", label="on a curved wall, over an edge"),
        Shot("surfaces", "glass", label="glass: clear, frosted, a bottle"),
        Shot("atrium_glass", "glass", label="in the atrium"),
        Shot("atrium", None, ("ao.intensity=0",), crop=CORNER, label="ambient occlusion off"),
        Shot("atrium", None, ao, crop=CORNER, label="on, intensity 1"),
        Shot("atrium", None, ao, "ssao", label="its factor"),
        Shot("atrium", None, (*ao, "gi.bounces=0"), "ssao", label="its factor without cones: 2 m"),
        Shot(model, None, ("gbuffer.blur=false",), crop=CLOSE, label="G-buffer blur off"),
        Shot(model, None, ("gbuffer.blur=true",), crop=CLOSE, label="on"),
    )


def main() -> None:
    """Draw and write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", nargs="?", type=Path, default=OUT)
    parser.add_argument("--blur", default="atrium", metavar="MODEL")
    words = parser.parse_args()
    sheet(Device.headless(), shots(words.blur), SIZE).save(words.out, quality=QUALITY)
    print(f"{words.out}: {words.out.stat().st_size} bytes")


if __name__ == "__main__":
    main()
