"""What cones cost at several resolutions of the octree, in turn, in CPU time of a software driver.

python tools/measure_cones.py [RESOLUTION…]: a row for each of the atrium, one gather. CPU time of
the process counts all of the driver's threads and leaves out the machine's other users; it says
nothing of a GPU: see `elemental bench` there.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "app"))

from elemental.frame import Renderer  # noqa: E402
from elemental.gpu.device import Device  # noqa: E402
from elemental.scene.model import Camera  # noqa: E402
from elemental.session import Viewpoint, set_stage  # noqa: E402

SCENE = "atrium"
SIZE = (320, 180)
SETTINGS = ("gi.bounces=1", "ao.intensity=0")
VIEWS = ("normal", "diffuse_gi", "specular_gi")
"""Each needs what the one before does and one thing more."""
ROUNDS = 15


def cpu_ms(renderer: Renderer, camera: Camera, view: str) -> float:
    """CPU time of one frame in which nothing changed."""
    began = time.process_time()
    renderer.render(camera, 0.0, 0, view)
    renderer.device.finish()
    return 1e3 * (time.process_time() - began)


def main() -> None:
    """Print a row for each resolution: the least of ROUNDS frames, and the ratio to the first."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("resolutions", nargs="*", type=int, default=[128, 512])
    resolutions = parser.parse_args().resolutions
    device = Device.headless()
    staged: dict[int, tuple[Renderer, Camera]] = {}
    for resolution in resolutions:
        words = (*SETTINGS, f"gi.resolution={resolution}")
        stage = set_stage(SCENE, words, Viewpoint(), SIZE)
        staged[resolution] = (
            Renderer(device, stage.scene, stage.settings, SIZE),
            stage.camera_at(0.0),
        )
        for view in VIEWS * 2:  # build, compile, learn the counts
            cpu_ms(*staged[resolution], view)
    least = {(r, view): float("inf") for r in resolutions for view in VIEWS}
    for _ in range(ROUNDS):
        for (r, view), before in least.items():
            least[r, view] = min(before, cpu_ms(*staged[r], view))
    print(f"| {device.info.renderer} | diffuse and 5x5, ms | specular, ms | ratio |")
    print("|---|---|---|---|")
    first = 0.0
    for r in resolutions:
        below, diffuse, both = (least[r, view] for view in VIEWS)
        first = first or both - below
        ratio = (both - below) / first
        print(f"| {r}³ | {diffuse - below:.0f} | {both - diffuse:.0f} | {ratio:.2f} |")


if __name__ == "__main__":
    main()
