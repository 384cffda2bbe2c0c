#!/usr/bin/env python3
"""What a frame costs in Python: `python tools/python_cost.py [--frames 60] [--profile]`.

Scenes that use all there is, with every effect on: first with every GL call an empty function, so
that the time is Python's alone, and with the driver's calls. Each frame moves the camera and what
moves in the scene. Milliseconds of the thread that runs Python, which other work on the machine
does not count into: the least and the median.
"""

from __future__ import annotations

import argparse
import cProfile
import pstats
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "app"))

from driverless import without_driver  # noqa: E402
from elemental.core.collector import collect_rarely  # noqa: E402
from elemental.frame import Renderer  # noqa: E402
from elemental.gpu.device import Device  # noqa: E402
from elemental.session import Stage, Viewpoint, set_stage  # noqa: E402

SIZE = (64, 36)
"""Pixels: of no account to Python, and the warm-up is quick."""
EVERYTHING = (
    "motion_blur.amount=0.5", "dof.enabled=true", "screen.percentage=90",
    "grain.intensity=0.1", "scene_color.fringe=0.2",
)  # fmt: skip
"""What is off by default."""
CYCLE, WARM_UP = 12, 30
"""Frames after which all comes again, and those before anything is measured: whatever is made when
it is first needed has been made by then."""
FPS = 24.0
SCENES = ("everything", "atrium", "many_lights", "surfaces")
LAMPS = 12


def everything() -> str:
    """A scene file: the atrium with its ball, glass, decals and a dozen lamps, half of them with
    shadows."""
    content = ROOT / "content" / "scenes"
    text = (content / "atrium_orb.toml").read_text().replace('"atrium/', f'"{content}/atrium/')
    parts = [
        text,
        f'[[models]]\nname = "glass"\nfile = "{content}/surfaces/glass.glb"\n'
        "translation = [-4.9, 0.0, 0.9]\n",
    ]
    for n in range(LAMPS):
        parts.append(
            f'[[lights]]\nkind = "point"\nposition = [{1.2 * n - 7}, 1.5, 0.5]\nintensity = 4.0\n'
            f"range = 4.0\ncasts_shadow = {str(n % 2 == 0).lower()}\n"
        )
    for n, image in enumerate(("poster", "crack", "splash")):
        parts.append(
            f'[[decals]]\nname = "{image}"\nposition = [{2 * n - 5}.0, 0.0, 0.5]\n'
            "direction = [0.0, -1.0, 0.0]\nup = [0.0, 0.0, -1.0]\nsize = [1.5, 1.5, 1.0]\n"
            f"order = {n}\n"
            f'parameters = {{ base_color_texture = "{content}/surfaces/{image}.png" }}\n'
        )
    return "\n".join(parts)


class Run:
    """Frames of one scene, each a little later and from elsewhere than the one before."""

    def __init__(self, device: Device, stage: Stage) -> None:
        self.device, self.stage = device, stage
        self.renderer = Renderer(device, stage.scene, stage.settings, SIZE)
        self._number = 0

    def frame(self) -> float:
        """CPU ms of `Renderer.render` on its thread."""
        step = self._number % CYCLE
        self._number += 1
        time_s = step / FPS
        camera = self.stage.camera_at(time_s)
        matrix = camera.world_from_view.copy()
        matrix[0, 3] += 0.01 * step
        camera = replace(camera, world_from_view=matrix)
        began = time.thread_time()
        self.renderer.render(camera, time_s, self._number)
        return 1e3 * (time.thread_time() - began)


def measure(name: str, frames: int, profiled: bool) -> None:
    """Print the row of one scene. The device is of no use afterwards."""
    collect_rarely()  # as the program does
    device = Device.headless()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "everything.toml"
        path.write_text(everything())
        scene = str(path) if name == SCENES[0] else name
        run = Run(device, set_stage(scene, EVERYTHING, Viewpoint(), SIZE))
    for _ in range(WARM_UP):
        run.frame()
        device.finish()
    passes = len(device.timings)
    with_driver = [run.frame() for _ in range(frames)]
    device.finish()
    profile = cProfile.Profile()
    with without_driver(device):
        python = [run.frame() for _ in range(frames)]
        if profiled:
            profile.runcall(lambda: [run.frame() for _ in range(frames)])
    cells = [f"{ms:.2f}" for t in (python, with_driver) for ms in (min(t), median(t))]
    print(f"| {name} | {passes} | " + " | ".join(cells) + " |", flush=True)
    if profiled:
        pstats.Stats(profile).sort_stats("tottime").print_stats(60)


def main() -> None:
    """Print a row for each scene, from a process of its own."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--frames", type=int, default=60, help="measured, default %(default)s")
    parser.add_argument("--profile", action="store_true", help="print where the time goes")
    words = parser.parse_args()
    if len(words.scenes) == 1:
        measure(words.scenes[0], words.frames, words.profile)
        return
    print("| scene | passes | Python: least | median | with the driver: least | median |")
    print("|---|---|---|---|---|---|", flush=True)
    for name in words.scenes:
        command = [sys.executable, __file__, name, "--frames", str(words.frames)]
        subprocess.run(command, check=True)


if __name__ == "__main__":
    main()
