"""``elemental render`` end to end: sequences and videos that can be interrupted. AP-02"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from cli.process import APP, assert_refused, elemental
from cli.small_scene import write_corner

SMALL = ("--size", "32x24", "--set", "gi.resolution=64", "--set", "shadow.resolution=256")
SCENE = """
[[models]]
file = "corner.gltf"
[camera_path]
keys = [{ time = 0.0, eye = [0.0, 1.0, 4.0], target = [0.0, 1.0, 0.0] },
        { time = 0.4, eye = [3.0, 1.0, 1.0], target = [0.0, 0.3, 0.0] }]
"""


@pytest.fixture(autouse=True)
def _scene(tmp_path: Path) -> None:
    write_corner(tmp_path)
    (tmp_path / "yard.toml").write_text(SCENE)


def render(folder: Path, *words: object) -> str:
    result = elemental("render", "yard.toml", *SMALL, *words, cwd=folder)
    assert result.returncode == 0, result.stderr
    return result.stdout


def frames(folder: Path) -> dict[str, bytes]:
    return {
        file.name: file.read_bytes() for file in sorted(folder.iterdir()) if file.stem.isdigit()
    }


def test_the_camera_path_gives_the_length_and_two_runs_the_same_bytes(tmp_path: Path) -> None:
    assert render(tmp_path, "-o", "a", "--fps", 20) == "a: 8 frames, 8 of them rendered now\n"
    render(tmp_path, "-o", "b", "--fps", 20)
    assert frames(tmp_path / "a") == frames(tmp_path / "b")
    assert list(frames(tmp_path / "a")) == [f"{k:05d}.png" for k in range(8)]
    assert len(set(frames(tmp_path / "a").values())) == 8
    assert render(tmp_path, "-o", "a", "--fps", 20) == "a: 8 frames, 0 of them rendered now\n"


def test_a_killed_run_goes_on_to_the_same_bytes(tmp_path: Path) -> None:
    words = ["--frames", "3:75", "--fps", "100"]
    render(tmp_path, "-o", "whole", *words)
    started = subprocess.Popen(
        [sys.executable, "-m", "elemental", "render", "yard.toml", *SMALL, *words, "-o", "killed"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(APP)},
    )
    folder, deadline = tmp_path / "killed", time.monotonic() + 60
    while len(list(folder.glob("*.png"))) < 40 and time.monotonic() < deadline:
        time.sleep(0.01)
    started.send_signal(signal.SIGKILL)
    started.wait()
    assert 40 <= len(list(folder.glob("*.png"))) < 72
    told = render(tmp_path, "-o", "killed", *words)
    assert not told.endswith(" 0 of them rendered now\n")
    assert frames(folder) == frames(tmp_path / "whole")


def test_linear_views_and_names_of_ones_own(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    words = ("--frames", "2:4", "--view", "scene_color")
    assert render(tmp_path, "-o", "out/light.%03d.exr", *words).startswith("out: 2 frames")
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == [
        "light.002.exr", "light.003.exr", "sequence.json",
    ]  # fmt: skip


def test_a_video_is_whole_or_not_there_and_leaves_no_frames(tmp_path: Path) -> None:
    words = ("--frames", "0:5", "--fps", "25")
    assert render(tmp_path, "-o", "a.mp4", *words) == "a.mp4: 5 frames, 5 of them rendered now\n"
    assert (tmp_path / "a.mp4").read_bytes()[4:8] == b"ftyp"
    assert not (tmp_path / "a.mp4.frames").exists()
    render(tmp_path, "-o", "b.mp4", *words)
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()


def test_a_missing_encoder_is_told_before_the_first_frame(tmp_path: Path) -> None:
    (tmp_path / "imageio_ffmpeg.py").write_text("raise ImportError('none')\n")
    words = ("render", "yard.toml", *SMALL, "--frames", "0:2", "-o", "a.mp4")
    paths = f"{tmp_path}{os.pathsep}{APP}"
    result = elemental(*words, cwd=tmp_path, PYTHONPATH=paths)
    assert_refused(result, "an .mp4 needs imageio-ffmpeg: pip install 'elemental[video]'")
    assert not (tmp_path / "a.mp4.frames").exists()


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("-o", "a", "--frames", "5:5"), "'5:5' is not A:B"),
        (("-o", "a", "--frames", "5"), "'5' is not A:B"),
        (("-o", "a.png"), "needs a frame number, as in %05d.png, or a folder"),
        (("-o", "a.avi"), "videos are .mp4; else a folder, or %05d.png"),
        (("-o", "a.%03d.jpg"), "the name must end in .png or .exr"),
        (("-o", "a/b/c"), "can't be made"),
        (("-o", "a.mp4", "--size", "33x24"), "an .mp4 needs even sides"),
        (("-o", "corner.gltf"), "is a file, not a folder"),
        (("-o", "a", "--camera", "front"), "needs A:B: the scene has no camera path"),
        (("-o", "a", "--view", "nonsense"), "no such name"),
    ],
)
def test_what_can_t_be_made_is_refused(
    tmp_path: Path, words: tuple[str, ...], expected: str
) -> None:
    assert_refused(elemental("render", "yard.toml", *SMALL, *words, cwd=tmp_path), expected)
