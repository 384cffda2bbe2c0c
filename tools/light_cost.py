"""What lights cost, culled and not: `python tools/light_cost.py [COUNT,COUNT,…]`.

Draws the scene many_lights with so many of its lamps, evenly thinned and without shadows, culled
and not in turn, and prints medians of a frame in ms: of one that shows direct light alone, and of a
whole one that lights its voxels anew. On a software driver that is CPU time of all threads, which
does not depend on what else runs; on others it is wall clock.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import replace

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.session import open_scene

SIZE = (320, 180)
COUNTS = (1, 16, 64, 256)
FRAMES = 5
SETTINGS = ("gi.bounces=1",)


def renderer(device: Device, count: int, culling: bool) -> Renderer:
    """The scene with `count` of its lights."""
    scene, settings = open_scene("many_lights", SETTINGS)
    lights, step = scene.lights, len(scene.lights) / count
    thinned = [lights[int(k * step)] for k in range(count)]
    scene.lights = [replace(light, casts_shadow=False) for light in thinned]
    return Renderer(device, scene, settings.replace({"lights.culling": culling}), SIZE)


def frame_ms(made: Renderer, view: str, clock: Callable[[], float]) -> float:
    """Of one frame, its voxels lit anew if the view shows them."""
    camera = made.scene.default_camera(SIZE[0] / SIZE[1])
    made.invalidate("light")
    begin = clock()
    made.render(camera, 0.0, 0, view)
    made.device.finish()
    return (clock() - begin) * 1e3


def main() -> None:
    """Print a line for each count."""
    counts = [int(word) for word in sys.argv[1].split(",")] if len(sys.argv) > 1 else COUNTS
    device = Device.headless()
    clock = time.process_time if device.info.software else time.perf_counter
    print(f"{device.info.renderer}, {SIZE[0]}x{SIZE[1]}, ms culled / not culled")
    for count in counts:
        pair = [renderer(device, count, culling) for culling in (True, False)]
        cells = []
        for view in ("direct", "final"):
            for made in pair:
                frame_ms(made, view, clock)
            taken = [[frame_ms(made, view, clock) for made in pair] for _ in range(FRAMES)]
            culled, whole = (statistics.median(column) for column in zip(*taken, strict=True))
            cells.append(f"{view} {culled:.0f} / {whole:.0f}")
        print(f"{count:4d} lights: {'; '.join(cells)}", flush=True)
        for made in pair:
            made.release()


if __name__ == "__main__":
    main()
