# AP-02
"""Sequences: whatever is missing is made as if the run had never been interrupted."""

from __future__ import annotations

import random
import subprocess
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

from cli.small_scene import write_corner
from elemental.core.errors import InputError
from elemental.core.images import read_png_jpeg_webp
from elemental.gpu.device import Device
from elemental.sequence import frames, video
from elemental.sequence.frames import Sequence
from elemental.sequence.manifest import FILE_NAME
from elemental.session import Viewpoint, set_stage

SIZE = (32, 24)
COUNT = 14
WORDS = ("gi.resolution=64", "shadow.resolution=256")
SCENE = """
[[models]]
file = "corner.gltf"
name = "corner"
[[lights]]
kind = "point"
name = "lamp"
position = [0.0, 1.0, 1.0]
intensity = 20.0
[camera_path]
keys = [{ time = 0.0, eye = [0.0, 1.0, 4.0], target = [0.0, 1.0, 0.0] },
        { time = 0.5, eye = [3.0, 1.0, 1.0], target = [0.0, 0.3, 0.0] }]
"""
MOTION = """
[[motions]]
model = "corner"
keys = [{ time = 0.0 }, { time = 0.5, translation = [0.5, 0.2, 0.0], rotation_deg = [0, 40, 0] }]
"""


@pytest.fixture(autouse=True)
def _short_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(frames, "BLOCK", 4)


@pytest.fixture(params=["still", "moving"])
def scene(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A camera that moves past a lamp, over things that stand or move."""
    write_corner(tmp_path)
    path = tmp_path / "yard.toml"
    path.write_text(SCENE + (MOTION if request.param == "moving" else ""))
    return path


def sequence(scene: Path, folder: str, count: int = COUNT, **changed: Any) -> Sequence:
    target = scene.parent / folder
    target.mkdir(exist_ok=True)
    words = (*WORDS, *changed.pop("words", ()))
    given: dict[str, Any] = {"view": "final", "first": 2, "last": count + 1, "fps": 24.0, **changed}
    stage = set_stage(str(scene), words, Viewpoint(), SIZE)
    return Sequence(stage, SIZE, **given, file=lambda frame: target / f"{frame:03d}.png")


def made(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in sorted(folder.glob("*.png"))}


@pytest.fixture
def whole(device: Device, scene: Path) -> dict[str, bytes]:
    """The frames of an uninterrupted run."""
    steps = list(sequence(scene, "whole").render(device))
    assert [step.frame for step in steps] == list(range(2, COUNT + 2))
    assert all(step.rendered for step in steps)
    return made(scene.parent / "whole")


def test_an_interrupted_run_goes_on_to_the_same_bytes(
    device: Device, scene: Path, whole: dict[str, bytes]
) -> None:
    assert len(set(whole.values())) == COUNT  # the eye and the camera are on the move
    for stops in ((1,), (4,), (5, 9), (3, 3, 3)):
        folder = f"stopped{stops}"
        done = 0
        for stop in stops:
            steps: Iterator[Any] = sequence(scene, folder).render(device)
            done = max(done, sum(1 for _ in islice(steps, stop)))
            steps.close()  # type: ignore[attr-defined]
        steps = sequence(scene, folder).render(device)
        assert [step.rendered for step in steps] == [False] * done + [True] * (COUNT - done)
        assert made(scene.parent / folder) == whole


def test_missing_and_broken_frames_are_made_again_and_whole_ones_kept(
    device: Device, scene: Path, whole: dict[str, bytes]
) -> None:
    folder, chance = scene.parent / "whole", random.Random(3)
    for _ in range(4):
        lost = chance.sample(sorted(whole), 3)
        (folder / lost[0]).unlink()
        (folder / lost[1]).write_bytes(whole[lost[1]][:-20])
        (folder / lost[2]).write_bytes(b"")
        stamps = {f.name: f.stat().st_mtime_ns for f in folder.glob("*.png") if f.name not in lost}
        steps = list(sequence(scene, "whole").render(device))
        assert {step.file.name for step in steps if step.rendered} == set(lost)
        assert made(folder) == whole
        assert all((folder / name).stat().st_mtime_ns == stamp for name, stamp in stamps.items())


def test_a_longer_run_keeps_the_shorter_one_s_frames(
    device: Device, scene: Path, whole: dict[str, bytes]
) -> None:
    list(sequence(scene, "longer", COUNT - 5).render(device))
    steps = list(sequence(scene, "longer").render(device))
    assert sum(step.rendered for step in steps) == 5
    assert made(scene.parent / "longer") == whole
    assert not any(step.rendered for step in sequence(scene, "longer", 3).render(device))


@pytest.mark.parametrize("scene", ["still"], indirect=True)
def test_frames_of_anything_else_are_not_mixed_in(device: Device, scene: Path) -> None:
    list(sequence(scene, "a", 3).render(device))
    before = made(scene.parent / "a")
    for changed, told in (
        ({"words": ("exposure=2",)}, "another exposure"),
        ({"view": "normal"}, "another view"),
        ({"fps": 25.0}, "another frames a second"),
        ({"first": 1}, "another first frame"),
    ):
        with pytest.raises(InputError, match=told):
            next(sequence(scene, "a", 3, **changed).render(device))
    scene.write_text(scene.read_text().replace("intensity = 20.0", "intensity = 21.0"))
    with pytest.raises(InputError, match="another scene"):
        next(sequence(scene, "a", 3).render(device))
    assert made(scene.parent / "a") == before
    (scene.parent / "a" / FILE_NAME).write_text("{}")
    with pytest.raises(InputError, match="is broken"):
        next(sequence(scene, "a", 3).render(device))
    (scene.parent / "a" / FILE_NAME).unlink()
    with pytest.raises(InputError, match="without a note"):
        next(sequence(scene, "a", 3).render(device))


@pytest.mark.parametrize("scene", ["still"], indirect=True)
def test_a_changed_file_that_a_setting_names_is_noticed(device: Device, scene: Path) -> None:
    lut = scene.parent / "a.cube"
    rows = [f"{r} {g} {b}" for b in (0, 1) for g in (0, 1) for r in (0, 1)]
    lut.write_text("\n".join(["LUT_3D_SIZE 2", *rows]))
    words = (f"color_grading.lut={lut}",)
    list(sequence(scene, "a", 1, words=words).render(device))
    assert not any(step.rendered for step in sequence(scene, "a", 1, words=words).render(device))
    lut.write_text("\n".join(["LUT_3D_SIZE 2", *reversed(rows)]))
    with pytest.raises(InputError, match="another file that a setting names"):
        next(sequence(scene, "a", 1, words=words).render(device))


@pytest.mark.parametrize("scene", ["still"], indirect=True)
def test_overwriting_leaves_no_frame_of_before(device: Device, scene: Path) -> None:
    list(sequence(scene, "a", 6).render(device))
    before = made(scene.parent / "a")
    steps = sequence(scene, "a", 3, words=("exposure=2",)).render(device, overwrite=True)
    next(steps)
    steps.close()  # type: ignore[attr-defined]
    assert len(made(scene.parent / "a")) == 1  # even of those that an interruption left to make
    list(sequence(scene, "a", 6, words=("exposure=2",)).render(device))
    after = made(scene.parent / "a")
    assert after.keys() == before.keys()
    assert all(after[name] != before[name] for name in after)


@pytest.mark.parametrize("scene", ["still"], indirect=True)
@pytest.mark.parametrize("view", ["scene_color", "voxels"])
def test_views_without_effects_have_sequences_too(device: Device, scene: Path, view: str) -> None:
    list(sequence(scene, "a", 6, view=view).render(device))
    whole = made(scene.parent / "a")
    (scene.parent / "a" / "006.png").unlink()
    list(sequence(scene, "a", 6, view=view).render(device))
    assert made(scene.parent / "a") == whole


@pytest.mark.parametrize("scene", ["still"], indirect=True)
def test_a_video_holds_the_frames(device: Device, scene: Path, whole: dict[str, bytes]) -> None:
    ffmpeg, folder = video.find_ffmpeg(), scene.parent
    for name in ("a.mp4", "b.mp4"):
        video.encode(ffmpeg, folder / "whole" / "%03d.png", 2, COUNT, 24.0, folder / name)
    assert (folder / "a.mp4").read_bytes() == (folder / "b.mp4").read_bytes()
    (folder / "back").mkdir()
    out = folder / "back" / "%03d.png"
    subprocess.run([ffmpeg, "-v", "error", "-i", folder / "a.mp4", out], check=True)
    back = sorted((folder / "back").iterdir())
    assert len(back) == COUNT
    for file, name in zip(back, whole, strict=True):
        ours, theirs = (read_png_jpeg_webp(p).astype(int) for p in (folder / "whole" / name, file))
        grey = abs(ours[..., :3].mean(axis=2) - theirs[..., :3].mean(axis=2))  # colour is halved
        assert grey.mean() < 4.0


def test_a_broken_encoder_leaves_the_old_video(tmp_path: Path) -> None:
    old = tmp_path / "a.mp4"
    old.write_bytes(b"old")
    with pytest.raises(InputError, match="can't be encoded"):
        video.encode(video.find_ffmpeg(), tmp_path / "%03d.png", 0, 3, 24.0, old)
    assert [file.name for file in tmp_path.iterdir()] == ["a.mp4"]
    assert old.read_bytes() == b"old"
