"""What decals cost: `python tools/decal_cost.py [COUNT,COUNT,…]`.

Draws the scene surfaces with none of its decals, with its own eight, and with so many of their
looks strewn over its floor and wall; CPU ms of a software driver, medians of ROUNDS frames in turn.
The process's own time counts all threads of the driver and leaves out the machine's other users.
"""

from __future__ import annotations

import statistics
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "app"))

from elemental.frame import Renderer  # noqa: E402
from elemental.gpu.device import Device  # noqa: E402
from elemental.passes.decal_pack import draw_order, runs_of  # noqa: E402
from elemental.scene.model import Decal  # noqa: E402
from elemental.session import Viewpoint, set_stage  # noqa: E402
from pass_clock import PassClock  # noqa: E402

SIZE = (320, 180)
SETTINGS = ("gi.bounces=1",)
COUNTS = (1000,)
ROUNDS = 9
SIDE_M = (0.1, 0.35)
"""Least and largest width of a strewn decal."""
DECALS = {
    "set apart": ("decal/receivers",),
    "blended": ("decal/decal",),
    "voxels": ("decal.paint",),
}
GROUPS = {**DECALS, "others": ("",)}


def strewn(decals: list[Decal], count: int) -> list[Decal]:
    """So many decals in the looks and orders of some, flat on the floor."""
    rng = np.random.default_rng(1)
    made = []
    for number in range(count):
        like = decals[number % len(decals)]
        width = rng.uniform(*SIDE_M)
        turn = rng.uniform(0.0, 2.0 * np.pi)
        right, up = (np.array([np.cos(a), 0.0, np.sin(a)]) for a in (turn, turn - np.pi / 2))
        matrix = np.eye(4)
        matrix[:3, :3] = np.stack([right, up, [0.0, 1.0, 0.0]], axis=1) * [width, width, 0.2]
        matrix[:3, 3] = rng.uniform(-2.4, 2.4), 0.0, rng.uniform(-2.4, 2.4)
        made.append(replace(like, world_from_decal=matrix.astype(np.float32)))
    return made


def frame_ms(made: Renderer, clock: PassClock, rebuild: bool) -> dict[str, float]:
    """Of one frame."""
    camera = next(c for c in made.scene.cameras if c.name == "room")
    made.invalidate("geometry" if rebuild else "view")
    clock.ms.clear()
    made.render(camera, 0.0, 0)
    made.device.finish()
    return {**{row: clock.ms[row] for row in DECALS}, "frame": sum(clock.ms.values())}


def main() -> None:
    """Print a line for each count."""
    counts = [int(word) for word in sys.argv[1].split(",")] if len(sys.argv) > 1 else COUNTS
    device = Device.headless()
    clock = PassClock(device, GROUPS)
    variants: dict[str, Renderer] = {}
    for count in (0, 8, *counts):
        stage = set_stage("surfaces", SETTINGS, Viewpoint("room"), SIZE)
        if count != 8:  # its own
            stage.scene.decals = strewn(stage.scene.decals, count)
        scene = stage.scene
        runs = len(runs_of(scene, draw_order(scene)))
        variants[f"{count:5d} decals, {runs:2d} draws"] = Renderer(
            device, scene, stage.settings, SIZE
        )
    print(f"{device.info.renderer}, {SIZE[0]}x{SIZE[1]}, CPU ms")
    for rebuild in (False, True):
        for made in variants.values():
            frame_ms(made, clock, rebuild)
        rounds = [
            {name: frame_ms(made, clock, rebuild) for name, made in variants.items()}
            for _ in range(ROUNDS)
        ]
        print("voxels built anew:" if rebuild else "a still scene:")
        for name in variants:
            rows = (*DECALS, "frame")
            cells = [(row, statistics.median(r[name][row] for r in rounds)) for row in rows]
            print(f"  {name}: " + ", ".join(f"{row} {ms:.2f}" for row, ms in cells), flush=True)
    for made in variants.values():
        made.release()


if __name__ == "__main__":
    main()
