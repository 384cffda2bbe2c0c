"""Seven scenes beside their path-traced pictures, at a size that a test can afford.

`NAME.exr` is the reference: linear radiance as half floats; its alpha is 1 where the eye meets
neither an emitter nor the sky, in `glass.exr` where it meets glass. `reached.json` holds how near
ours came; it may only come nearer. `tools/update_accuracy.py` makes both. Nothing here needs the
path tracer.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenEXR

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.session import Stage, Viewpoint, set_stage
from reference.metrics import compare, hdr_flip

Array = npt.NDArray[np.float32]

FOLDER = Path(__file__).parent
TABLE = FOLDER / "reached.json"

GATHERS = 6
SETTINGS = (
    "gi.resolution=64",
    f"gi.bounces={GATHERS}",
    "gi.diffuse_cones=36",
    "gi.diffuse_pattern=6",
    "gi.area_lights=true",
    "gi.area_shadows=maps",
    "gi.specular=true",
    "gi.specular_adaptive=true",
    "ao.intensity=0",
    "gbuffer.blur=false",
    "shadow.resolution=1024",
)
"""Stated, so that another default changes nothing here."""
SAMPLES = 3
"""Of our pictures along a side of a pixel. The path tracer's pixels are means over their area; one
of ours says what stands at its middle, which of an arcade seen from afar is off by a tenth."""


@dataclass(frozen=True)
class Case:
    """A scene, how it is seen and what is set beyond SETTINGS; `reference` names the picture.

    `glass`: only where the eye meets glass is looked at, else all surfaces are.
    """

    scene: str
    reference: str
    camera: str | None = None
    size: tuple[int, int] = (96, 54)
    settings: tuple[str, ...] = field(default=())
    glass: bool = False

    @property
    def file(self) -> Path:
        return FOLDER / f"{self.reference}.exr"

    def stage(self) -> Stage:
        """The scene with the settings that both sides share."""
        return set_stage(
            self.scene, (*SETTINGS, *self.settings), Viewpoint(camera=self.camera), self.size
        )


CASES = {
    "cornell_box": Case("cornell_box", "cornell_box", size=(72, 72)),
    "cornell_box_9_cones": Case(
        "cornell_box", "cornell_box", size=(72, 72), settings=("gi.diffuse_cones=9",)
    ),
    "corridor": Case("corridor", "corridor"),
    "grate": Case("grate", "grate"),
    "glossy_floor": Case("glossy_floor", "glossy_floor"),
    "under_sky": Case("under_sky", "under_sky"),
    "atrium": Case("atrium", "atrium", camera="courtyard"),
    "glass": Case("glass", "glass", glass=True),
}

SLACK = {"energy": 0.005, "p50": 0.005, "p90": 0.015, "flip": 0.004}
"""How much worse a figure may be than the table's: drivers round differently."""


def draw(device: Device, case: Case) -> Array:
    """Our `scene_color` (H, W, 3), each pixel the mean of SAMPLES x SAMPLES."""
    stage = case.stage()
    width, height = case.size
    renderer = Renderer(device, stage.scene, stage.settings, (width * SAMPLES, height * SAMPLES))
    try:
        picture = renderer.read(renderer.render(stage.camera, 0.0, 0, "scene_color"))
        device.finish()
        fine = picture[..., :3].reshape(height, SAMPLES, width, SAMPLES, 3)
        return np.ascontiguousarray(fine.mean(axis=(1, 3)), np.float32)
    finally:
        renderer.release()


def write_reference(path: Path, radiance: Array, mask: Array) -> None:
    """Radiance (H, W, 3) and mask (H, W) as an EXR of half floats."""
    pixels = np.concatenate([radiance, mask[..., None]], axis=2).astype(np.float16)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGBA": np.ascontiguousarray(pixels)}).write(str(path))


def read_reference(path: Path) -> tuple[Array, Array]:
    """(radiance (H, W, 3), mask (H, W))."""
    pixels = OpenEXR.File(str(path)).channels()["RGBA"].pixels.astype(np.float32)
    return np.ascontiguousarray(pixels[..., :3]), pixels[..., 3]


def figures(ours: Array, reference: Array, mask: Array) -> dict[str, float]:
    """How far ours is off, each 0 where it is the reference.

    energy: ratio of the sums of luminance, less 1; p50, p90: percentiles of the relative error; all
    three over the mask. flip: mean HDR-FLIP of the whole picture.
    """
    found = compare(ours, reference, mask)
    return {
        "energy": found["energy_ratio"] - 1.0,
        "p50": found["relative_error"]["p50"],
        "p90": found["relative_error"]["p90"],
        "flip": hdr_flip(ours, reference),
    }


def reached() -> dict[str, Any]:
    """The table: for each case its figures, for each reference how it was made."""
    table: dict[str, Any] = json.loads(TABLE.read_text())
    return table


def worse(now: dict[str, float], before: dict[str, float]) -> list[str]:
    """What fell behind the table, in words."""
    return [
        f"{name} {now[name]:.4f}, was {before[name]:.4f}"
        for name, slack in SLACK.items()
        if not abs(now[name]) <= abs(before[name]) + slack
    ]
