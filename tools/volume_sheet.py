"""Draws docs/gallery/volumes.jpg: a walk into a post-process volume, each step with its weight.
`PYTHONPATH=app python tools/volume_sheet.py [OUT.jpg]`
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from elemental.core import transforms
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.scene.model import Camera
from elemental.scene.volumes import Volume
from elemental.session import open_scene

OUT = Path(__file__).resolve().parent.parent / "docs" / "gallery" / "volumes.jpg"
SIZE = (320, 200)
QUALITY = 88
FADE_M = 3.0
ARCADE = Volume(
    "arcade",
    center=(0.0, 2.5, -6.0),
    size=(24.0, 5.0, 2.6),
    blend_radius=FADE_M,
    overrides={
        "exposure": 2.0,
        "scene_color.tint": (0.4, 0.8, 1.2),
        "indirect.intensity": 1.4,
        "bloom.intensity": 2.0,
        "vignette.intensity": 1.0,
    },
)
STEPS_Z_M = (-1.2, -2.4, -3.2, -3.95, -5.6)
"""Where the eye stands, from the court into the arcade."""
SETTINGS = ("eye_adaptation.min_brightness=1", "eye_adaptation.max_brightness=1")
"""A fixed exposure, so that all that changes is the volume."""


def main() -> None:
    """Draw and write it: the walk without the volume above, with it below."""
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else OUT
    device = Device.headless()
    scene, settings = open_scene("atrium", SETTINGS)
    renderer = Renderer(device, scene, settings, SIZE)
    sheet = Image.new("RGB", (SIZE[0] * len(STEPS_Z_M), SIZE[1] * 2))
    draw = ImageDraw.Draw(sheet)
    for column, z in enumerate(STEPS_Z_M):
        eye = (-5.2, 2.5, z)
        view_from_world = transforms.look_at(eye, (6.0, 2.0, z + 0.6))
        camera = Camera("walk", transforms.inverse(view_from_world), math.radians(58.0), 0.05)
        for row, volumes in enumerate(([], [ARCADE])):
            scene.volumes = volumes
            frame = renderer.render(camera, 0.0, column)
            picture = Image.fromarray(np.ascontiguousarray(renderer.read(frame)[..., :3]))
            device.finish()
            corner = (column * SIZE[0], row * SIZE[1])
            sheet.paste(picture, corner)
            label = f"weight {ARCADE.weight(eye):.2f}" if volumes else "without the volume"
            draw.text((corner[0] + 7, corner[1] + 7), label, fill=(0, 0, 0))
            draw.text((corner[0] + 6, corner[1] + 6), label, fill=(255, 255, 255))
    sheet.save(out, quality=QUALITY)
    print(f"{out}: {out.stat().st_size} bytes")


if __name__ == "__main__":
    main()
