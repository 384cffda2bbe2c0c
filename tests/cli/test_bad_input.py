"""Bad words and files: one line, exit code 2, nothing written."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cli.process import APP, assert_refused, elemental, python
from cli.small_scene import BROKEN_FILES, write_corner

BAD_WORDS: list[tuple[list[str], str]] = [
    ([], "COMMAND"),
    (["shoot"], "'shoot'"),
    (["shot"], "-o/--output"),
    (["shot", "-o"], "-o/--output"),
    (["shot", "-o", "out.png", "--bogus"], "--bogus"),
    (["shot", "-o", "out.png", "--siz", "8x8"], "--siz"),
    (["shot", "-o", "out.png", "a.gltf", "b.gltf"], "b.gltf"),
    (["shot", "-o", "out.png", "--size", "8"], "--size"),
    (["shot", "-o", "out.png", "--size", "0x8"], "--size"),
    (["shot", "-o", "out.png", "--size", "99999x8"], "--size"),
    (["shot", "-o", "out.png", "--frames", "0"], "--frames"),
    (["shot", "-o", "out.png", "--frames", "1.5"], "--frames"),
    (["shot", "-o", "out.png", "--fps", "0"], "--fps"),
    (["shot", "-o", "out.png", "--fps", "nan"], "--fps"),
    (["shot", "-o", "out.png", "--time", "-1"], "--time"),
    (["shot", "-o", "out.png", "--seed", "x"], "--seed"),
    (["shot", "-o", "out.png", "--fov", "0"], "--fov"),
    (["shot", "-o", "out.png", "--eye", "1,2"], "--eye"),
    (["shot", "-o", "out.png", "--eye", "1e30,0,0"], "-1e+09 to 1e+09 metres"),
    (["shot", "-o", "out.png", "--target", "-1,b,2"], "--target"),
    (["run", "--frames", "-1"], "--frames"),
    (["run", "-o", "out.png"], "-o"),
    (["bench", "--warmup", "-1"], "--warmup"),
    (["bench", "--rebuild", "everything"], "--rebuild"),
    (["list"], "what"),
    (["list", "colours"], "'colours'"),
    (["list", "cameras"], "SCENE"),
    (["list", "views", "corner.gltf"], "corner.gltf"),
]

BAD_SHOTS: list[tuple[list[str], str]] = [
    (["-o", "out.jpg"], "out.jpg"),
    (["-o", "out"], "must end in .png or .exr"),
    (["-o", "nowhere/out.png"], "the folder nowhere does not exist"),
    (["-o", "folder.png"], "is a folder"),
    (["-o", "."], "is a folder"),
    (["-o", "corner.gltf/out.png"], "corner.gltf does not exist"),
    (["-o", "a" * 260 + ".png"], "File name too long"),
    (["-o", "a" * 200 + "%99d.png"], "File name too long"),
    (["-o", "q%99999999d.png"], "'%99999999d' is wider than 99 digits"),
    (["-o", "out.png", "--report", "a" * 260 + ".json"], "--report"),
    (["-o", "out.png", "--report", "out.txt"], "--report"),
    (["-o", "out.png", "--report", "nowhere/r.json"], "nowhere"),
    (["-o", "out.png", "--view", "finl"], "did you mean 'final'?"),
    (["-o", "out.png", "--view", "colour"], "known: final, scene_color"),
    (["-o", "out.png", "--size", "16384x16384"], "--size: 16384x16384: this driver draws at most"),
    (["-o", "out.png", "--set", "gi.resolution"], "expected key=value"),
    (["-o", "out.png", "--set", "gi.resolutoin=64"], "did you mean gi.resolution?"),
    (["-o", "out.png", "--set", "gi.resolution=65"], "64, 128, 256, 512"),
    (["-o", "out.png", "--set", "exposure=bright"], "exposure"),
    (["-o", "out.png", "--set", "sky.image=nowhere.hdr"], "nowhere.hdr"),
    (["-o", "out.png", "--set", "sky.image=corner.gltf"], "corner.gltf"),
    (["-o", "out.png", "--camera", "frnt"], "did you mean 'front'?"),
    (["-o", "out.png", "--eye", "0,0,1"], "--target"),
    (["-o", "out.png", "--eye", "0,0,1", "--target", "0,0,1"], "same point"),
    (["-o", "out.png", "--camera", "front", "--eye", "0,0,1", "--target", "0,0,0"], "--camera"),
]


@pytest.mark.parametrize(("words", "expected"), BAD_WORDS, ids=str)
def test_bad_words_are_refused(tmp_path: Path, words: list[str], expected: str) -> None:
    assert_refused(elemental(*words, cwd=tmp_path), expected)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("words", "expected"), BAD_SHOTS, ids=str)
def test_bad_values_of_a_shot_are_refused(tmp_path: Path, words: list[str], expected: str) -> None:
    write_corner(tmp_path)
    (tmp_path / "folder.png").mkdir()
    before = sorted(tmp_path.rglob("*"))
    assert_refused(elemental("shot", "corner.gltf", *words, cwd=tmp_path), expected)
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize("name", BROKEN_FILES)
def test_a_broken_file_is_refused_by_name(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(BROKEN_FILES[name])
    result = elemental("shot", name, "-o", "out.png", "--report", "r.json", cwd=tmp_path)
    assert_refused(result, name)
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_missing_file_and_an_unknown_scene_are_refused(tmp_path: Path) -> None:
    for name in ("nowhere.gltf", "no_such_scene"):
        assert_refused(elemental("list", "cameras", name, cwd=tmp_path))


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_cannot_be_written_is_refused(tmp_path: Path) -> None:
    write_corner(tmp_path)
    locked = tmp_path / "locked"
    locked.mkdir(mode=0o500)
    result = elemental("shot", "corner.gltf", "-o", "locked/out.png", cwd=tmp_path)
    assert_refused(result, "can't be written")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_file_that_is_read_only_is_kept(tmp_path: Path) -> None:
    write_corner(tmp_path)
    (tmp_path / "out.png").write_bytes(b"mine")
    (tmp_path / "out.png").chmod(0o444)
    assert_refused(elemental("shot", "corner.gltf", "-o", "out.png", cwd=tmp_path), "read-only")
    assert (tmp_path / "out.png").read_bytes() == b"mine"


def test_without_a_display_a_window_is_refused(tmp_path: Path) -> None:
    scene = write_corner(tmp_path)
    result = elemental("run", scene, "--frames", 1, DISPLAY="", WAYLAND_DISPLAY="")
    assert_refused(result, "elemental shot")


def test_odd_names_of_scenes_are_refused(tmp_path: Path) -> None:
    for name, reason in (("a" * 5000, "neither a file nor one"), ("", "neither a file nor one"),
                         (".", "is a folder")):  # fmt: skip
        assert_refused(elemental("list", "cameras", name, cwd=tmp_path), reason)


def test_a_package_that_is_not_there_is_named(tmp_path: Path) -> None:
    words = ["shot", str(write_corner(tmp_path)), "-o", str(tmp_path / "out.png")]
    code = (
        f"import sys; sys.modules['moderngl'] = None; from elemental.cli import main; main({words})"
    )
    result = python("-c", code)
    assert result.stderr.startswith("elemental: error: needs moderngl: pip install elemental")
    assert result.stderr.count("\n") == 1


def test_the_reference_refuses_bad_words_in_a_line() -> None:
    pytest.importorskip("mitsuba")
    result = python(APP.parent / "tools" / "ground_truth.py", "x.glb", "--spp", "0")
    assert result.returncode == 2
    assert result.stderr == "ground_truth: error: --spp: '0' is not a whole number, 1 to 1048576\n"
