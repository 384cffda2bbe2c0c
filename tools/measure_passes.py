"""What a rebuilt frame of the atrium costs by passes, at several resolutions of the octree.

python tools/measure_passes.py [RESOLUTION…]: CPU ms of a software driver, the least of ROUNDS
frames in turn. The process's own time counts all threads of the driver and leaves out the machine's
other users; each pass is waited for. It says nothing of a GPU: see `elemental bench` there.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "app"))

from elemental.frame import Renderer  # noqa: E402
from elemental.gpu.device import Device  # noqa: E402
from elemental.session import Viewpoint, set_stage  # noqa: E402
from pass_clock import PassClock  # noqa: E402

SCENE = "atrium"
SIZE = (320, 180)
SETTINGS = ("gi.bounces=1",)
WARM_UP = 2
ROUNDS = 5
GROUPS = {
    "voxelize, 3 axes": ("voxelize",),
    "octree build": ("voxel/mark", "reduce", "voxel/scan", "voxel/nodes", "voxel/lists",
                     "clear voxel.points", "clear octree.node"),
    "link, resolve": ("voxel/link", "voxel/resolve", "clear octree.attributes",
                      "clear octree.radiance"),
    "light": ("light voxels",),
    "mip filter": ("filter", "clear voxel.sided"),
    "border, compress": ("voxel/compress", "clear octree"),
    "diffuse cones": ("cones.diffuse",),
    "combine 5x5": ("cones.combine",),
    "specular cones": ("cones.specular",),
    "all else": ("",),
}  # fmt: skip
"""Row -> what the names of its passes begin with; the first row that fits takes a pass."""
CONES = ("diffuse cones", "specular cones")


def frame_ms(clock: PassClock, renderer: Renderer, camera: Any) -> dict[str, float]:
    """CPU ms of a frame that rebuilds everything, by row."""
    clock.ms.clear()
    renderer.invalidate("geometry")
    renderer.render(camera, 0.0, 0)
    renderer.device.finish()
    return {row: clock.ms[row] for row in GROUPS}


def main() -> None:
    """Print a row for each group of passes, and what the octree holds."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("resolutions", nargs="*", type=int, default=[64, 128, 256, 512])
    resolutions = parser.parse_args().resolutions
    device = Device.headless()
    clock = PassClock(device, GROUPS)
    staged = {}
    for r in resolutions:
        words = (*SETTINGS, f"gi.resolution={r}")
        stage = set_stage(SCENE, words, Viewpoint(), SIZE)
        staged[r] = Renderer(device, stage.scene, stage.settings, SIZE), stage.camera_at(0.0)
        for _ in range(WARM_UP):
            frame_ms(clock, *staged[r])
    least = {r: dict.fromkeys(GROUPS, float("inf")) for r in resolutions}
    for _ in range(ROUNDS):
        for r in resolutions:
            now = frame_ms(clock, *staged[r])
            least[r] = {row: min(ms, now[row]) for row, ms in least[r].items()}
    print(f"| {device.info.renderer} | " + " | ".join(f"{r}³" for r in resolutions) + " |")
    print("|---" * (len(resolutions) + 1) + "|")
    for row in GROUPS:
        print(f"| {row} | " + " | ".join(f"{least[r][row]:.0f}" for r in resolutions) + " |")
    sums = [sum(least[r].values()) for r in resolutions]
    print("| all | " + " | ".join(f"{ms:.0f}" for ms in sums) + " |")
    cones = [sum(least[r][row] for row in CONES) for r in resolutions]
    print("| cones, by the first | " + " | ".join(f"{ms / cones[0]:.2f}" for ms in cones) + " |")
    octrees = [staged[r][0]._voxels for r in resolutions]
    bricks = [f"{o.counts.bricks:,}" if o is not None else "" for o in octrees]
    print("| bricks | " + " | ".join(bricks) + " |")


if __name__ == "__main__":
    main()
