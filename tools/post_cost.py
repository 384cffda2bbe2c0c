"""What each post-processing effect costs: `python tools/post_cost.py [--size 1280x720]`.

All effects develop one made-up picture; the best times by effect and per megapixel, and how long
the calls of a frame take.
"""

from __future__ import annotations

import argparse
import time
from collections import defaultdict
from types import SimpleNamespace
from typing import Any

import numpy as np

from elemental.core import transforms
from elemental.gpu.device import Device
from elemental.gpu.formats import D24S8, RGBA16F
from elemental.passes.camera_view import pack_view
from elemental.passes.post.develop import develop
from elemental.passes.post.history import PostHistory
from elemental.scene.model import Camera
from elemental.settings import Settings

EFFECTS = {
    "post.half": "halving, for the next three",
    "post/histogram": "eye adaptation",
    "post/adapt": "eye adaptation",
    "post/bloom": "bloom",
    "bloom": "bloom",
    "post.quarter": "lens flares",
    "post/sprite": "lens flares",
    "post/ghosts": "lens flares",
    "read sprites": "lens flares",
    "post/tonemap": "film, grading, vignette, grain, fringe",
    "post/fxaa": "FXAA",
    "post/dof": "depth of field",
    "post/motion": "motion blur",
    "post/upscale": "screen percentage",
}
"""Start of a pass's name -> the effect that it belongs to."""
OPTIONS = {"dof.enabled": True, "motion_blur.amount": 0.5}
"""What is off by default."""
WARM_UP = 3


def main() -> None:
    """Print two tables: the defaults, and with the options on top."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--size", default="1280x720", help="pixels, default %(default)s")
    parser.add_argument("--frames", type=int, default=9, help="measured, default %(default)s")
    words = parser.parse_args()
    width, height = (int(extent) for extent in words.size.split("x"))
    device = Device.headless()
    for name, settings in (("defaults", Settings()), ("with options", Settings(OPTIONS))):
        costs, python_ms = measure(device, settings, (width, height), words.frames)
        megapixels = width * height / 1e6
        print(f"\n{name}, {width}x{height}, {device.info.renderer}")
        for effect, ms in {**costs, "sum": sum(costs.values())}.items():
            print(f"  {effect:42s}{ms:8.2f} ms {ms / megapixels:8.2f} ms/MP")
        print(f"  Python and the driver's calls               {python_ms:6.2f} ms a frame")


def measure(
    device: Device, settings: Settings, size: tuple[int, int], frames: int
) -> tuple[dict[str, float], float]:
    """(least ms by effect, least ms until the calls return): other work on a machine only adds."""
    history = PostHistory(device, settings)
    width, height = size
    rng = np.random.default_rng(1)
    smooth = np.kron(rng.normal(-2.0, 1.5, (height // 8 + 1, width // 8 + 1)), np.ones((8, 8)))
    pixels = np.repeat(np.exp2(smooth[:height, :width, None]), 4, axis=2).astype(np.float16)
    depths = rng.uniform(0.9, 1.0, smooth.shape)[:height, :width]
    codes = (depths * (2.0**24 - 1)).astype(np.uint32) << 8
    picture = device.texture("picture", size, RGBA16F, data=pixels)
    gb: Any = SimpleNamespace(depth=device.texture("depth", size, D24S8, data=codes))
    bounds = (np.full(3, -20, np.float32), np.full(3, 20, np.float32))
    times: dict[str, list[float]] = defaultdict(list)
    calls: list[float] = []
    for frame in range(WARM_UP + frames):
        place = transforms.look_at((0.02 * frame, 0, 0), (0.02 * frame, 0, -1))
        camera = Camera("cost", transforms.inverse(place), 0.9, 0.1)
        view = pack_view(camera, size, bounds, time_s=frame / 30.0, frame=frame)
        began = time.perf_counter()
        g = device.begin_frame()
        source: Any = picture
        g.keep(develop(g, view, source, gb, settings, history))
        g.execute()
        issued = time.perf_counter()
        device.finish()
        if frame < WARM_UP:
            continue
        calls.append(1e3 * (issued - began))
        spent: dict[str, float] = defaultdict(float)
        for timing in device.timings:
            spent[effect_of(timing.name)] += timing.gpu_ms
        for effect, ms in spent.items():
            times[effect].append(ms)
    history.release()
    picture.release()
    gb.depth.release()
    return {effect: min(ms) for effect, ms in times.items()}, min(calls)


def effect_of(name: str) -> str:
    """The effect that a pass belongs to."""
    return next((effect for start, effect in EFFECTS.items() if name.startswith(start)), name)


if __name__ == "__main__":
    main()
