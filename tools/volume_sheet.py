"""Draws docs/gallery/volumes.jpg: along the path of `atrium_walk`, without its volumes and with.
`PYTHONPATH=app python tools/volume_sheet.py [OUT.jpg]`
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from elemental.frame import Renderer
from elemental.session import Viewpoint, headless_device, set_stage

OUT = Path(__file__).resolve().parent.parent / "docs" / "gallery" / "volumes.jpg"
SIZE = (384, 216)
QUALITY = 88
TIMES_S = (0.5, 5.5, 8.0, 17.0, 19.9)
"""In the arcade, between its columns, in the court, towards the shrine, before it."""
CUT_S = 100.0
"""From one picture to the next: after a cut the eye starts adapted."""


def main() -> None:
    """Draw and write it: the walk without the volumes above, with them below."""
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else OUT
    stage = set_stage("atrium_walk", (), Viewpoint(), SIZE)
    device = headless_device()
    renderer = Renderer(device, stage.scene, stage.settings, SIZE)
    sheet = Image.new("RGB", (SIZE[0] * len(TIMES_S), SIZE[1] * 2))
    draw = ImageDraw.Draw(sheet)
    volumes = list(stage.scene.volumes)
    for column, time_s in enumerate(TIMES_S):
        camera = stage.camera_at(time_s)
        x, y, z = (float(part) for part in camera.world_from_view[:3, 3])
        for row, at_work in enumerate(([], volumes)):
            stage.scene.volumes = at_work
            number = 2 * column + row
            frame = renderer.render(camera, CUT_S * number, number)
            picture = Image.fromarray(np.ascontiguousarray(renderer.read(frame)[..., :3]))
            device.finish()
            corner = (column * SIZE[0], row * SIZE[1])
            sheet.paste(picture, corner)
            weights = {v.name: v.weight((x, y, z)) for v in at_work}
            told = "  ".join(f"{name} {share:.2f}" for name, share in weights.items() if share)
            label = told or "without volumes"
            draw.text((corner[0] + 7, corner[1] + 7), label, fill=(0, 0, 0))
            draw.text((corner[0] + 6, corner[1] + 6), label, fill=(255, 255, 255))
    sheet.save(out, quality=QUALITY)
    print(f"{out}: {out.stat().st_size} bytes")


if __name__ == "__main__":
    main()
