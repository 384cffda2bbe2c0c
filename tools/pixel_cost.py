"""What passes over the G-buffer cost a pixel: `python tools/pixel_cost.py [SCENE [CAMERA]]`.

Nanoseconds of CPU time a pixel of a frame, as of a still scene seen by a moving eye with the
program's defaults on a software driver: the least of ROUNDS frames, and their share of the frame.
It says nothing of a GPU: see `elemental bench` there.
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "app"))

from elemental.frame import Renderer  # noqa: E402
from elemental.gpu.device import Device  # noqa: E402
from elemental.session import Viewpoint, set_stage  # noqa: E402
from pass_clock import PassClock  # noqa: E402

SIZE = (320, 180)
ROUNDS = 18
WARM_UP = 2
GROUPS = {
    "G-buffer": ("gbuffer/", "gbuffer.", "z-prepass"),
    "decals": ("decal",),
    "SSAO": ("ssao",),
    "G-buffer blur": ("gbuffer_blur",),
    "diffuse cones": ("cones.diffuse", "cone_trace/diffuse", "cones.combine", "cone_trace/combine"),
    "specular cones": ("cones.specular", "cone_trace/specular"),
    "area lights": ("cone_trace/area", "cones.area"),
    "shading": ("shade",),
    "light from behind": ("cone_trace/through",),
    "pictures of what is behind glass": ("behind",),
    "translucent surfaces": ("forward",),
    "FXAA": ("post/fxaa",),
    "all else": ("",),
}
"""Row -> what the names of its passes begin with; the first row that fits takes a pass."""


def main() -> None:
    """Print a row for each group of passes that ran."""
    scene = sys.argv[1] if len(sys.argv) > 1 else "atrium"
    camera = sys.argv[2] if len(sys.argv) > 2 else None
    device = Device.headless()
    clock = PassClock(device, GROUPS)
    stage = set_stage(scene, (), Viewpoint(camera), SIZE)
    renderer = Renderer(device, stage.scene, stage.settings, SIZE)
    least = dict.fromkeys(GROUPS, float("inf"))
    for number in range(WARM_UP + ROUNDS):
        clock.ms.clear()
        renderer.invalidate("view")
        renderer.render(stage.camera_at(0.0), 0.0, number)
        device.finish()
        if number >= WARM_UP:
            least = {row: min(ms, clock.ms[row]) for row, ms in least.items()}
    renderer.release()
    whole = sum(least.values())
    print(f"{scene}, {device.info.renderer}, {SIZE[0]}x{SIZE[1]}")
    print("| pass | ns a pixel | of the frame |\n|---|---|---|")
    for row, ms in least.items():
        if ms > 0.0:
            print(f"| {row} | {1e6 * ms / (SIZE[0] * SIZE[1]):.0f} | {ms / whole:.1%} |")


if __name__ == "__main__":
    main()
