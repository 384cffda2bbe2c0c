"""How still the atrium stays while a glowing ball drifts through it.

python tools/measure_flicker.py [--camera NAME] [--set KEY=VALUE…] [--sheet FILE.png]: a line of
figures (tests/accuracy/flicker.py says what they are), and a contact sheet to look at.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "app")]

from accuracy.flicker import flicker  # type: ignore[import-not-found]  # noqa: E402
from elemental.core.images import write_png  # noqa: E402
from elemental.frame import Renderer  # noqa: E402
from elemental.gpu.device import Device  # noqa: E402
from elemental.session import Viewpoint, set_stage  # noqa: E402

SCENE = "atrium_orb"
SIZE = (256, 144)
FRAMES = 24
FPS = 24.0
BEGIN_S = 0.5
"""The ball is then in the middle of the court, in front of the camera."""
COLUMNS = 4


def main() -> None:
    """Print the figures; write the sheet where one is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--camera", default=None, metavar="NAME", help="of the scene")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--frames", type=int, default=FRAMES)
    parser.add_argument("--sheet", type=Path, default=None, metavar="FILE.png")
    words = parser.parse_args()
    stage = set_stage(SCENE, words.set, Viewpoint(camera=words.camera), SIZE)
    device = Device.headless()
    renderer = Renderer(device, stage.scene, stage.settings, SIZE)
    camera = stage.camera_at(0.0)
    times = [BEGIN_S + k / FPS for k in range(words.frames)]
    found = flicker(renderer, camera, times)
    print(
        f"{camera.name}: {found.far:.0%} of the picture is far: deviation {found.deviation:.3%}, "
        f"99.9 % within {found.most:.2%}, jitter {found.jitter:.3%}; "
        f"where lit, jitter {found.lit_jitter:.2%}"
    )
    if words.sheet is not None:
        frames = (renderer.render(camera, t, k) for k, t in enumerate(times))
        shown = [renderer.read(frame)[..., :3] for frame in frames]
        rows = [np.hstack(shown[k : k + COLUMNS]) for k in range(0, len(shown), COLUMNS)]
        write_png(words.sheet, np.vstack(rows))


if __name__ == "__main__":
    main()
