"""Moving scenes through the commands, end to end."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image
import pytest
from numpy.typing import NDArray

import shapes
from cli.process import APP, elemental
from cli.xvfb import display
from gltf_builder import GltfBuilder

__all__ = ["display"]

SMALL = ("--size", "48x32", "--set", "gi.resolution=64", "--set", "shadow.resolution=256")
LAMP = """
models = [{ file = "stage.glb" }, { file = "ball.glb", translation = [0, 2, 0] }]
[[motions]]
model = "ball"
orbit = { center = [0, 2, -1], period = 4.0 }
"""


@pytest.fixture(autouse=True)
def _scenes(tmp_path: Path) -> None:
    """stage.glb: a floor, a box that slides in 2 s, a camera that sinks; ball.glb; orbit.toml."""
    builder = GltfBuilder()
    builder.add(*shapes.quad(6.0), material=builder.material((0.8, 0.8, 0.8, 1)))
    cube = builder.add(*shapes.box(), material=builder.material((0.8, 0.1, 0.1, 1)))
    builder.camera(translation=[0, 1, 6], name="still")
    sinking = builder.camera(translation=[0, 4, 6], name="sinking")
    builder.light("directional", {"intensity": 3.0}, rotation=[-0.5, 0.2, 0.0, 0.84])
    builder.animation((cube, "translation", [0, 1, 2], [[-1, 0.5, 0], [1, 0.5, 0], [-1, 0.5, 0]]),
                      name="slide")  # fmt: skip
    builder.animation((sinking, "translation", [0, 1], [[0, 4, 6], [0, 1, 6]]), name="sink")
    builder.write(tmp_path / "stage.glb")
    builder = GltfBuilder()
    builder.add(*shapes.sphere(0.4), material=builder.material((0, 0, 0, 1), emissive=(1, 1, 0)))
    builder.write(tmp_path / "ball.glb")
    (tmp_path / "orbit.toml").write_text(LAMP)


def shot(folder: Path, scene: str, *words: object) -> NDArray[np.int64]:
    result = elemental("shot", scene, "-o", "a.png", *SMALL, *words, cwd=folder)
    assert result.returncode == 0, result.stderr
    with PIL.Image.open(folder / "a.png") as image:
        return np.asarray(image).astype(int)


def redness(picture: NDArray[np.int64]) -> float:
    """The mean column of what is red, -1 at the left edge to 1 at the right one."""
    red = (picture[..., 0] > 60) & (picture[..., 1] < picture[..., 0] // 2)
    columns = np.nonzero(red)[1]
    assert len(columns) > 5
    return float(columns.mean() + 0.5) / picture.shape[1] * 2 - 1


def test_a_shot_s_time_moves_the_scene(tmp_path: Path) -> None:
    places = [redness(shot(tmp_path, "stage.glb", "--time", t)) for t in (0, 0.5, 1, 2)]
    assert places[0] < -0.1
    assert abs(places[1]) < 0.05
    assert places[2] > 0.1
    assert places[3] == places[0]


def test_frames_go_on_by_the_frame_rate(tmp_path: Path) -> None:
    alone = shot(tmp_path, "stage.glb", "--time", 0.5)
    words = ("-o", "s.%d.png", "--frames", 3, "--fps", 4, "--set", "gi.enabled=false")
    shot(tmp_path, "stage.glb", *words)
    pictures = []
    for k in range(3):
        with PIL.Image.open(tmp_path / f"s.{k}.png") as image:
            pictures.append(np.asarray(image).astype(int))
    places = [redness(picture) for picture in pictures]
    assert places[0] < places[1] < places[2]
    assert places[2] == pytest.approx(redness(alone), abs=0.02)


def test_a_setting_chooses_the_animation(tmp_path: Path) -> None:
    still = ("--set", "scene.animation=none")
    words = ("--camera", "still", "--time", 1.0)
    rest = redness(shot(tmp_path, "stage.glb", *words, *still))
    assert rest == redness(shot(tmp_path, "stage.glb", *words, "--set", "scene.animation=sink"))
    assert redness(shot(tmp_path, "stage.glb", *words, "--set", "scene.animation=slide")) > rest
    result = elemental("shot", "stage.glb", "-o", "b.png", "--set", "scene.animation=x",
                       cwd=tmp_path)  # fmt: skip
    assert result.returncode == 2
    assert "stage.glb: scene.animation: no animation is named 'x'" in result.stderr


def test_an_animated_camera_moves(tmp_path: Path) -> None:
    words = ("--camera", "sinking", "--set", "scene.animation=sink", "--time")
    high, low = (shot(tmp_path, "stage.glb", *words, t) for t in (0.0, 0.999999))
    still = shot(tmp_path, "stage.glb", "--camera", "still", "--set", "scene.animation=none")
    assert np.abs(high - still).max() > 30
    assert np.abs(low - still).mean() < 1.0


def test_a_scene_file_s_motion_plays(tmp_path: Path) -> None:
    def yellow(t: float) -> float:
        picture = shot(tmp_path, "orbit.toml", "--camera", "still", "--time", t)
        lit = (picture[..., 1] > 120) & (picture[..., 2] < picture[..., 1] // 2)
        return float(np.nonzero(lit)[1].mean() + 0.5) / picture.shape[1] * 2 - 1

    # From in front of the centre towards the right: counter-clockwise as seen from above.
    assert abs(yellow(0.0)) < 0.05
    assert yellow(1.0) > 0.1
    assert yellow(3.0) < -0.1


def test_animations_are_listed(tmp_path: Path) -> None:
    result = elemental("list", "animations", "stage.glb", cwd=tmp_path)
    assert result.stdout.splitlines() == ["slide", "sink"]
    result = elemental("list", "animations", "orbit.toml", cwd=tmp_path)
    assert result.stdout.splitlines() == ["slide", "sink", '[[motions]] model "ball": orbit']
    result = elemental("list", "animations", cwd=tmp_path)
    assert "list animations: SCENE: name a scene" in result.stderr
    assert result.returncode == 2


def test_a_benchmark_moves_the_scene_unless_its_rate_is_0(tmp_path: Path) -> None:
    words = ("--size", "32x24", "--frames", 2, "--warmup", 2, "--set", "gi.resolution=64")
    passes = []
    for fps in (30, 0):
        result = elemental("bench", "stage.glb", *words, "--fps", fps, "--json", "b.json",
                           cwd=tmp_path)  # fmt: skip
        assert result.returncode == 0, result.stderr
        report: Any = json.loads((tmp_path / "b.json").read_text())
        assert report["fps"] == fps
        passes.append({entry["name"].split(".")[0] for entry in report["passes"]})
    assert "voxelize" in passes[0]
    assert not passes[1] & {"voxelize", "shadow"}


WINDOW = """
from elemental.session import Viewpoint, set_stage
from elemental.ui.app import App, Run
from elemental.ui.window import Window

words = Run("stage.glb", (96, 64), ["gi.enabled=false", "shadow.resolution=256"], False, None)
stage = set_stage(words.scene, words.assignments, Viewpoint(), words.size)
window = Window(words.size, "", words.fullscreen)
app = App(window, stage, words)

def moved():
    app.desk.clock.advance(0.1)
    app.draw(window.framebuffer_size())
    return len(app.desk.renderer._meshes.changes)

print(*[moved() for _ in range(3)][1:])
app.act("pause")
print(*[moved() for _ in range(2)])
app.act("step")
print(moved())
app.act("camera.pick", 1)
sinking = app.desk.fly.camera().world_from_view[1, 3]
print(1.0 < sinking < 4.0)
app.release()
"""


def test_a_window_plays_and_pauses(tmp_path: Path, display: str) -> None:
    """One thing moves in each frame, none while paused; a camera is where it is by then."""
    environment = os.environ | {
        "PYTHONPATH": str(APP), "DISPLAY": display, "XDG_CONFIG_HOME": str(tmp_path / "config")
    }  # fmt: skip
    result = subprocess.run(
        [sys.executable, "-c", WINDOW], cwd=tmp_path, env=environment,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert result.stderr == ""
    assert result.stdout.splitlines() == ["1 1", "0 0", "1", "True"]


def test_broken_animations_are_refused_in_one_line(tmp_path: Path) -> None:
    builder = GltfBuilder()
    node = builder.add(*shapes.box())
    builder.animation((node, "translation", [0, 0], [[0, 0, 0], [1, 0, 0]]))
    builder.write(tmp_path / "broken.glb")
    result = elemental("shot", "broken.glb", "-o", "b.png", cwd=tmp_path)
    assert result.returncode == 2
    expected = "broken.glb: animations[0].samplers[0].input: times do not increase at key 1"
    assert result.stderr == f"elemental: error: {expected}\n"
    assert not (tmp_path / "b.png").exists()
