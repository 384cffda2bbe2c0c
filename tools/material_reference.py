"""Draws materials beside a path tracer: `PYTHONPATH=app python tools/material_reference.py`.

The material ball in three ways of `standard` into docs/gallery/material_reference.jpg; with
`--helmet FlightHelmet.gltf --sky FILE.hdr` Khronos' model under that sky and a sun into
docs/gallery/flight_helmet.jpg instead. Figures are those of ground_truth.py.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

from elemental.core.paths import content_root

GALLERY = Path(__file__).resolve().parent.parent / "docs" / "gallery"
QUALITY = 90
BALL_SIZE, HELMET_SIZE = "200x175", "240x220"
MATERIALS = {
    "red": "base_color = [0.75, 0.03, 0.03, 1.0], roughness = 0.25, metallic = 0.0",
    "gold": "base_color = [1.0, 0.71, 0.29, 1.0], roughness = 0.3, metallic = 1.0",
    "chalk": "base_color = [0.8, 0.8, 0.8, 1.0], roughness = 1.0, metallic = 0.0",
}
HELMET = """exposure_ev = 0.0
[[models]]
file = "{model}"
[environment]
file = "{sky}"
intensity = 0.6
[[lights]]
kind = "directional"
direction = [-0.5, -0.8, -0.6]
intensity = 2.5
[[cameras]]
name = "front"
eye = [0.3, 0.45, 1.35]
target = [0.0, 0.345, 0.0]
fov_y_deg = 34.0
near = 0.05
[settings]
"gi.bounces" = 2
"""


def balls(folder: Path) -> list[Path]:
    """A scene file a material, beside the content that the ball's scene names."""
    scenes = content_root() / "scenes"
    text = (scenes / "material_ball.toml").read_text(encoding="utf-8")
    for name in ("material_ball/ball.glb", "atrium/sky.hdr"):
        text = text.replace(name, (scenes / name).as_posix())
    made = []
    for name, parameters in MATERIALS.items():
        path = folder / f"{name}.toml"
        path.write_text(f'{text}\n[[materials]]\nname = "Ball"\nparameters = {{ {parameters} }}\n')
        made.append(path)
    return made


def helmet(folder: Path, model: Path, sky: Path) -> list[Path]:
    """The helmet's scene file."""
    path = folder / "helmet.toml"
    path.write_text(HELMET.format(model=model.resolve().as_posix(), sky=sky.resolve().as_posix()))
    return [path]


def compared(scene: Path, size: str, spp: int) -> Image.Image:
    """Ours, the reference and the error of a scene."""
    picture = scene.with_suffix(".png")
    tool = Path(__file__).with_name("ground_truth.py")
    words = [str(scene), "--size", size, "--spp", str(spp), "--out", str(picture)]
    subprocess.run([sys.executable, str(tool), *words], check=True)
    return Image.open(picture).convert("RGB")


def stacked(pictures: Sequence[Image.Image]) -> Image.Image:
    """One below the other."""
    whole = Image.new("RGB", (pictures[0].width, sum(picture.height for picture in pictures)))
    top = 0
    for picture in pictures:
        whole.paste(picture, (0, top))
        top += picture.height
    return whole


def main() -> None:
    """Draw and write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--spp", type=int, default=256, help="samples a pixel (256)")
    parser.add_argument("--helmet", type=Path, metavar="MODEL.gltf")
    parser.add_argument("--sky", type=Path, metavar="FILE.hdr")
    words = parser.parse_args()
    if (words.helmet is None) != (words.sky is None):
        parser.error("--helmet and --sky go together")
    with TemporaryDirectory() as name:
        folder = Path(name)
        if words.helmet is None:
            scenes, size, out = balls(folder), BALL_SIZE, GALLERY / "material_reference.jpg"
        else:
            scenes = helmet(folder, words.helmet, words.sky)
            size, out = HELMET_SIZE, GALLERY / "flight_helmet.jpg"
        stacked([compared(scene, size, words.spp) for scene in scenes]).save(out, quality=QUALITY)
    print(f"{out}: {out.stat().st_size} bytes")


if __name__ == "__main__":
    main()
