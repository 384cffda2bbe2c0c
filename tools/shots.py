"""Pictures of scenes for sheets: what is shown, and several of them beside each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.session import Viewpoint, set_stage

COLUMNS = 2


@dataclass(frozen=True)
class Shot:
    """A scene by one of its cameras, or its first."""

    scene: str
    camera: str | None = None
    settings: tuple[str, ...] = ()
    view: str = "final"
    crop: tuple[float, float, float] = (0.5, 0.5, 1.0)
    """(across, down, share): the part of that share of the sides of a larger picture."""
    label: str = ""


def picture(device: Device, shot: Shot, size: tuple[int, int]) -> Image.Image:
    """The shot at a size, (width, height) px."""
    x, y, share = shot.crop
    whole = (round(size[0] / share), round(size[1] / share))
    stage = set_stage(shot.scene, shot.settings, Viewpoint(shot.camera), whole)
    renderer = Renderer(device, stage.scene, stage.settings, whole)
    pixels = renderer.read(renderer.render(stage.camera_at(0.0), 0.0, 0, shot.view))[..., :3]
    device.finish()
    renderer.release()
    image = Image.fromarray(np.ascontiguousarray(pixels))
    left, top = round(x * (whole[0] - size[0])), round(y * (whole[1] - size[1]))
    return image.crop((left, top, left + size[0], top + size[1]))


def sheet(device: Device, shots: Sequence[Shot], size: tuple[int, int]) -> Image.Image:
    """All of them at a size, COLUMNS a row, each with its label in its corner."""
    rows = -(-len(shots) // COLUMNS)
    whole = Image.new("RGB", (size[0] * min(COLUMNS, len(shots)), size[1] * rows))
    pen = ImageDraw.Draw(whole)
    for number, shot in enumerate(shots):
        corner = (number % COLUMNS * size[0], number // COLUMNS * size[1])
        whole.paste(picture(device, shot, size), corner)
        for shift, shade in ((1, 0), (0, 255)):
            pen.text((corner[0] + 7 + shift, corner[1] + 6 + shift), shot.label, fill=(shade,) * 3)
    return whole
