"""Pictures of the post-processing effects: `python tools/post_sheet.py [effects|walk]`.

`effects`: each one off and at two strengths over one frame; `walk`: out of a dark arcade into the
sunlit court and back, with what the eye measures and adapts to. Into docs/gallery.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image
import PIL.ImageDraw

from elemental.core import transforms
from elemental.core.layout import layouts
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.scene.model import Camera, Scene
from elemental.session import Viewpoint, set_stage
from elemental.settings import Settings

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "gallery"
QUALITY = 80
LABEL_PX, GAP_PX = 14, 8
CELL, BLOCKS = (288, 162), 2
"""Size of a picture of the effects, px; blocks of three beside each other."""
EYE, TARGET = (5.2, 1.5, 1.0), (9.9, 0.9, 1.5)
"""Before the glowing crystal, half of the picture dark."""
CRYSTAL = 4.0
"""Times as bright as in its scene, so that the frame has what a lens flares of."""
TEXT, GRID, AXIS = (235, 235, 235), (60, 60, 60), (150, 150, 150)
MEASURED, ADAPTED = (110, 160, 255), (255, 170, 60)

GHOSTS = {"lens_flare.intensity": 16.0}
OFF = {
    "eye_adaptation.min_brightness": 0.5, "eye_adaptation.max_brightness": 0.5,
    "bloom.intensity": 0.0, "lens_flare.intensity": 0.0, "vignette.intensity": 0.0,
}  # fmt: skip
GLOW = {"bloom.threshold": 0.5}
FLARE = {"lens_flare.threshold": 2.5, "lens_flare.bokeh_size": 4.0}
FOCUS = {"dof.enabled": True, "dof.focal_distance": 390.0, "dof.near_transition": 120.0}
DIRT = {**GLOW, "bloom.intensity": 2.0, "bloom.dirt_mask": "dirt.png"}
WHITE = "film.white_point"
EFFECTS: tuple[tuple[str, tuple[dict[str, Any], dict[str, Any]]], ...] = (
    ("bloom.intensity 2, 8", ({**GLOW, "bloom.intensity": 2.0}, {**GLOW, "bloom.intensity": 8.0})),
    ("bloom.dirt_intensity 2, 8",
     ({**DIRT, "bloom.dirt_intensity": 2.0}, {**DIRT, "bloom.dirt_intensity": 8.0})),
    ("lens_flare.intensity 8, 16",
     ({**FLARE, "lens_flare.intensity": 8.0}, {**FLARE, "lens_flare.intensity": 16.0})),
    ("lens_flare.bokeh_size 2, 8 %",
     ({**FLARE, **GHOSTS, "lens_flare.bokeh_size": 2.0},
      {**FLARE, **GHOSTS, "lens_flare.bokeh_size": 8.0})),
    ("dof.f_stop 8, 3", ({**FOCUS, "dof.f_stop": 8.0}, {**FOCUS, "dof.f_stop": 3.0})),
    ("motion_blur.amount 0.5, 1", ({"motion_blur.amount": 0.5}, {"motion_blur.amount": 1.0})),
    ("exposure -1, +1", ({"exposure": -1.3}, {"exposure": 0.7})),
    ("film.slope 0.6, 1.2", ({"film.slope": 0.6}, {"film.slope": 1.2})),
    ("film.white_point 5000, 9000", ({WHITE: 5000.0}, {WHITE: 9000.0})),
    ("color_grading.intensity 0.5, 1 of evening.cube",
     ({"color_grading.lut": "evening.cube", "color_grading.intensity": 0.5},
      {"color_grading.lut": "evening.cube"})),
    ("vignette.intensity 0.4, 1", ({"vignette.intensity": 0.4}, {"vignette.intensity": 1.0})),
    ("grain.intensity 0.1, 0.2", ({"grain.intensity": 0.1}, {"grain.intensity": 0.2})),
    ("scene_color.fringe 0.5, 1",
     ({"scene_color.fringe": 0.5}, {"scene_color.fringe": 1.0})),
    ("scene_color.tint, half way and all",
     ({"scene_color.tint": (0.85, 0.95, 1.1)}, {"scene_color.tint": (0.7, 0.9, 1.2)})),
    ("film.toe 0.45, 0.65", ({"film.toe": 0.45}, {"film.toe": 0.65})),
    ("screen.percentage 75, 50", ({"screen.percentage": 75.0}, {"screen.percentage": 50.0})),
)  # fmt: skip
"""(what is written beside it, (weak, strong) over OFF)."""


def main() -> None:
    """Draw the asked-for sheets, or both."""
    device = Device.headless()
    for name in sys.argv[1:] or ("effects", "walk"):
        path = FOLDER / f"post-{name}.jpg"
        {"effects": effects, "walk": walk}[name](device).save(path, quality=QUALITY)
        print(path)


def effects(device: Device) -> PIL.Image.Image:
    """An effect in each block of three: off, weak, strong."""
    words = ("gi.bounces=1", "gi.resolution=128")
    stage = set_stage("atrium", words, Viewpoint(eye=EYE, target=TARGET), CELL)
    brighten(stage.scene, "crystal", CRYSTAL)
    plain = stage.settings.replace(OFF)
    renderer = Renderer(device, stage.scene, plain, CELL)
    still = stage.camera
    before = moved(still, (0.0, -0.25, 0.0))  # where motion blur comes from
    rows = -(-len(EFFECTS) // BLOCKS)
    pitch = (3 * CELL[0] + GAP_PX, CELL[1] + LABEL_PX)
    sheet = PIL.Image.new("RGB", (BLOCKS * pitch[0] - GAP_PX, rows * pitch[1]))
    pen = PIL.ImageDraw.Draw(sheet)
    frame = 0
    for place, (label, strengths) in enumerate(EFFECTS):
        left, top = place // rows * pitch[0], place % rows * pitch[1]
        pen.text((left + 4, top + 1), f"off | {label}", fill=TEXT)
        for number, given in enumerate(({}, *strengths)):
            renderer.set_settings(plain.replace(given))
            renderer.render(before, frame / 30.0, frame)
            picture = renderer.read(renderer.render(still, (frame + 1) / 30.0, frame + 1))
            device.finish()
            image = PIL.Image.fromarray(np.ascontiguousarray(picture[..., :3]))
            sheet.paste(image, (left + number * CELL[0], top + LABEL_PX))
            frame += 2
    renderer.release()
    return sheet


def brighten(scene: Scene, name: str, factor: float) -> None:
    """Have a material of the scene emit more."""
    for number, material in enumerate(scene.materials):
        if material.name == name:
            red, green, blue = (factor * float(part) for part in material.emissive)
            scene.materials[number] = material.with_value("emissive", (red, green, blue))


def moved(camera: Camera, by: tuple[float, float, float]) -> Camera:
    """The camera, somewhere else; by: m in its own axes."""
    matrix = camera.world_from_view.copy()
    matrix[:3, 3] += matrix[:3, :3] @ np.array(by, np.float32)
    return replace(camera, world_from_view=matrix)


DARK = ((-7.2, 1.7, -5.9), (4.0, 2.0, -4.9))
BRIGHT = ((-2.6, 1.7, 0.8), (6.0, 3.6, -0.6))
FPS, WALK_S, REST_S = 12, 1.5, 1.5
LAST_S = 4.5
"""In the arcade again, s: eyes get used to the dark slowly."""


def path(time_s: float) -> Camera:
    """Rest in the arcade, walk out, rest, walk back."""
    lap = [REST_S, WALK_S, REST_S, WALK_S]
    starts = np.cumsum([0.0, *lap])
    leg = int(np.searchsorted(starts, time_s, side="right")) - 1
    share = (time_s - starts[min(leg, 4)]) / lap[min(leg, 3)]
    smooth = share * share * (3 - 2 * share)
    out = {0: 0.0, 1: smooth, 2: 1.0, 3: 1.0 - smooth}.get(leg, 0.0)
    eye, target = (
        tuple((1 - out) * np.array(a) + out * np.array(b))
        for a, b in zip(DARK, BRIGHT, strict=True)
    )
    return Camera("walk", transforms.inverse(transforms.look_at(eye, target)), 1.0, 0.05)


def walk(device: Device) -> PIL.Image.Image:
    """Pictures along the walk over a plot of the eye's brightness."""
    size = (192, 108)
    words = ("eye_adaptation.min_brightness=0.03", "gi.bounces=1")
    stage = set_stage("atrium", words, Viewpoint(), size)
    renderer = Renderer(device, stage.scene, stage.settings, size)
    frames = int(FPS * (2 * WALK_S + 2 * REST_S + LAST_S)) + 1
    measured, adapted, pictures = [], [], []
    for frame in range(frames):
        image = renderer.render(path(frame / FPS), frame / FPS, frame)
        pictures.append(renderer.read(image)[..., :3])
        device.finish()
        eye = renderer.eye.read(layouts().struct("Eye"), 1)[0]
        measured.append(float(eye["measured"]))
        adapted.append(float(eye["brightness"]))
    renderer.release()
    columns, rows = 6, 2
    chosen = np.linspace(0, frames - 1, columns * rows).round().astype(int)
    sheet = PIL.Image.new("RGB", (columns * size[0], rows * size[1] + 240))
    for place, frame in enumerate(chosen):
        at = (place % columns * size[0], place // columns * size[1])
        sheet.paste(PIL.Image.fromarray(pictures[frame]), at)
        label = f"{frame / FPS:.1f} s"
        PIL.ImageDraw.Draw(sheet).text((at[0] + 4, at[1] + 2), label, fill=TEXT)
    plot(sheet, rows * size[1], measured, adapted, stage.settings)
    return sheet


def plot(
    sheet: PIL.Image.Image,
    top: int,
    measured: Sequence[float],
    adapted: Sequence[float],
    settings: Settings,
) -> None:
    """Brightness over time, logarithmic, on the lower part of a sheet."""
    pen = PIL.ImageDraw.Draw(sheet)
    left, right, low, high = 60, sheet.width - 12, sheet.height - 26, top + 14
    least, most = -4.0, 1.0  # log2 of nit

    def place(frame: int, brightness: float) -> tuple[float, float]:
        share = (math.log2(brightness) - least) / (most - least)
        return left + (right - left) * frame / (len(measured) - 1), low + (high - low) * share

    for stop in range(int(least), int(most) + 1):
        y = place(0, 2.0**stop)[1]
        pen.line([(left, y), (right, y)], fill=GRID)
        pen.text((6, y - 6), f"2^{stop} nit", fill=AXIS)
    for second in range(len(measured) // FPS + 1):
        x = place(second * FPS, 1.0)[0]
        pen.line([(x, low), (x, low + 4)], fill=AXIS)
        pen.text((x - 6, low + 8), f"{second} s", fill=AXIS)
    for values, color in ((measured, MEASURED), (adapted, ADAPTED)):
        pen.line([place(f, b) for f, b in enumerate(values)], fill=color, width=2)
    up, down = settings["eye_adaptation.speed_up"], settings["eye_adaptation.speed_down"]
    pen.text((left + 10, high), "measured between the percentiles", fill=MEASURED)
    pen.text((left + 240, high), f"adapted: speed up {up:g}/s, down {down:g}/s", fill=ADAPTED)


if __name__ == "__main__":
    main()
