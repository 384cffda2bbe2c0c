"""``elemental list``, ``--help`` and ``--version``."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from cli.process import APP, assert_refused, elemental
from cli.small_scene import corner, write_corner
from elemental.flags import build_parser
from elemental.scene.definitions import builtin, definition_names
from elemental.settings import SETTINGS
from elemental.ui.bindings import BINDINGS


def lines(*words: object, cwd: Path | None = None) -> list[str]:
    result = elemental(*words, cwd=cwd)
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
    return result.stdout.splitlines()


def test_settings_bindings_and_views_have_a_line_each() -> None:
    assert [line.split()[0] for line in lines("list", "settings")] == list(SETTINGS)
    assert [line.rsplit("  ")[-1].strip() for line in lines("list", "bindings")] == [
        binding.help for binding in BINDINGS
    ]
    views = [line.split(maxsplit=1) for line in lines("list", "views")]
    assert all(len(line) == 2 for line in views)


def test_materials_stand_over_their_parameters() -> None:
    told = lines("list", "materials")
    heads = [line.partition(":")[0] for line in told if not line.startswith(" ")]
    assert heads == definition_names()
    for name in heads:
        at = next(k for k, line in enumerate(told) if line.startswith(f"{name}:"))
        for k, parameter in enumerate(builtin(name).parameters):
            words = told[at + 1 + k].split()
            assert words[:2] == [parameter.name, parameter.kind]
            assert told[at + 1 + k].endswith(parameter.help)


def test_scenes_and_cameras_can_be_named(tmp_path: Path) -> None:
    write_corner(tmp_path)
    assert lines("list", "cameras", "corner.gltf", cwd=tmp_path) == ["front"]
    scenes = lines("list", "scenes")
    assert {"atrium", "atrium_walk"} <= set(scenes)


def test_a_scene_without_cameras_says_so(tmp_path: Path) -> None:
    gltf = corner()
    del gltf["cameras"], gltf["nodes"][3]["camera"]
    (tmp_path / "blind.gltf").write_text(json.dumps(gltf))
    result = elemental("list", "cameras", "blind.gltf", cwd=tmp_path)
    assert (result.returncode, result.stdout) == (0, "")
    assert result.stderr == "elemental: note: no cameras\n"


def test_the_version_is_told() -> None:
    assert lines("--version") == ["elemental 0.1.0"]


@pytest.mark.parametrize("command", ["shot", "render", "run", "bench", "list"])
def test_every_flag_has_one_line_of_help_with_its_default(command: str) -> None:
    parser = build_parser(dict.fromkeys(("shot", "render", "run", "bench", "list"), lambda _: None))
    subparser = next(a for a in parser._actions if a.choices and command in a.choices)
    assert isinstance(subparser.choices, dict)
    for action in subparser.choices[command]._actions:
        assert action.help
        assert "\n" not in action.help
        if action.dest != "help" and action.option_strings:
            assert "default" in action.help
    assert "usage: elemental" in "".join(lines(command, "--help"))


def in_shell(words: str) -> subprocess.CompletedProcess[str]:
    """``elemental WORDS`` with the shell's redirections."""
    command = f"{sys.executable} -m elemental {words}"
    environment = os.environ | {"PYTHONPATH": str(APP)}
    return subprocess.run(
        command, shell=True, env=environment, capture_output=True, text=True, check=False
    )


def test_a_closed_pipe_ends_quietly() -> None:
    assert in_shell("list settings | true").stderr == ""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
def test_a_full_disk_is_told_in_one_line() -> None:
    for words in ("list settings", "list scenes"):
        result = in_shell(f"{words} > /dev/full")
        assert_refused(result, "No space left on device")


def test_a_closed_output_is_told_in_one_line() -> None:
    assert_refused(in_shell("list settings >&-"), "the standard output is closed")
