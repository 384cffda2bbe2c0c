"""What a moving thing costs in a scene ten times as large.

python tools/measure_scale.py [--set KEY=VALUE]…: the ball of `atrium_orb` among one atrium and
among ten side by side, in frames in turn, each moment from the same camera. CPU ms of a software
driver, the least of ROUNDS frames by groups of passes, then all and the ratio to the first column.
On a GPU: --write FOLDER for the two scene files, and `elemental bench FILE` of each.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "app"))

from elemental.frame import Frame, Renderer  # noqa: E402
from elemental.gpu.device import Device  # noqa: E402
from elemental.session import Viewpoint, set_stage  # noqa: E402
from pass_clock import PassClock  # noqa: E402

SIZE = (320, 180)
FPS = 24.0
WARM_UP, ROUNDS = 4, 9
STEP_M = (24.0, 15.6)
"""From one atrium to the next, along x and z: wall to wall."""
GRID = (5, 2)
MODEL = '[[models]]\nfile = "atrium/atrium.glb"\n'
GROUPS = {
    "voxels": ("vox", "link", "filter", "light voxels", "reduce", "clear octree", "copy octree",
               "clear voxel", "copy scene.lists", "read octree"),
    "shadows": ("shadow", "copy shadow"),
    "culling": ("cull", "depth.pyramid", "clear scene.cull", "read scene.cull", "gbuffer.depth"),
    "G-buffer": ("gbuffer.",),
    "cones": ("cones", "clear specular", "read specular"),
    "all else": ("",),
}  # fmt: skip
"""Row -> what the names of its passes begin with; the first row that fits takes a pass."""


def scene_texts() -> dict[str, str]:
    """Scene files by name: the ball among one atrium, and among ten."""
    content = ROOT / "content" / "scenes"
    text = (content / "atrium_orb.toml").read_text()
    assert MODEL in text, "atrium_orb.toml places the atrium otherwise"
    models = []
    for row in range(GRID[1]):
        for column in range(GRID[0]):
            place = [column * STEP_M[0], 0.0, row * STEP_M[1]]
            models.append(f'{MODEL}name = "atrium {column} {row}"\ntranslation = {place}\n')
    texts = {"one": text, "ten": text.replace(MODEL, "\n".join(models))}
    return {n: t.replace('"atrium/', f'"{content}/atrium/') for n, t in texts.items()}


def main() -> None:
    """Print a row for each group of passes, and what was drawn."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--write", type=Path, metavar="FOLDER", help="write the scenes and stop")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        files = {}
        for name, text in scene_texts().items():
            files[name] = (options.write or Path(folder)) / f"{name}_atriums.toml"
            files[name].write_text(text)
        if options.write is None:
            compare(files, options.set)


def compare(files: dict[str, Path], words: list[str]) -> None:
    """Measure the scenes in turn and print the table."""
    device = Device.headless()
    clock = PassClock(device, GROUPS)
    staged = {}
    for name, file in files.items():
        stage = set_stage(str(file), words, Viewpoint(), SIZE)
        staged[name] = Renderer(device, stage.scene, stage.settings, SIZE), stage.camera_at(0.0)
    least = {name: dict.fromkeys(GROUPS, float("inf")) for name in staged}
    drawn: dict[str, Frame] = {}
    for number in range(WARM_UP + ROUNDS):
        for name, (renderer, camera) in staged.items():
            clock.ms.clear()
            drawn[name] = renderer.render(camera, number / FPS, number)
            device.finish()
            if number >= WARM_UP:
                least[name] = {row: min(ms, clock.ms[row]) for row, ms in least[name].items()}
    print(f"| {device.info.renderer} | " + " | ".join(staged) + " | ratio |")
    print("|---" * (len(staged) + 2) + "|")
    for row in GROUPS:
        _print_row(row, [least[name][row] for name in staged], "{:.1f}")
    _print_row("all", [sum(least[name].values()) for name in staged], "{:.1f}")
    for counter in ("instances_drawn", "instances_outside", "instances_hidden", "triangles_drawn"):
        counts = [frame.counters[counter] for frame in drawn.values()]
        _print_row(counter.replace("_", " "), counts, "{:,}")


def _print_row(name: str, values: Sequence[float], form: str) -> None:
    ratio = f"{values[-1] / values[0]:.2f}" if values[0] else ""
    print(f"| {name} | " + " | ".join(form.format(value) for value in values) + f" | {ratio} |")


if __name__ == "__main__":
    main()
