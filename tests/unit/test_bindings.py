"""The table of bindings: complete, without clashes, each key known to GLFW."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from elemental.ui.bindings import BINDINGS


def test_no_key_does_two_things() -> None:
    keys = [(key, binding.ctrl) for binding in BINDINGS for key in binding.keys]
    assert len(keys) == len(set(keys))
    actions = [binding.action for binding in BINDINGS]
    assert len(actions) == len(set(actions))


def test_glfw_knows_every_key() -> None:
    keys = [key for binding in BINDINGS if binding.kind != "mouse" for key in binding.keys]
    code = "import imgui_bundle, glfw, sys; [getattr(glfw, 'KEY_' + k) for k in sys.argv[1:]]"
    subprocess.run([sys.executable, "-c", code, *keys], check=True)


def test_keys_read_as_on_a_keyboard() -> None:
    texts = {binding.action: binding.keys_text() for binding in BINDINGS}
    assert texts["camera.pick"] == "1 to 9"
    assert texts["step"] == "."
    assert texts["fly.up"] == "E or Page Up"
    assert texts["help"] == "F1"
    assert texts["undo"] == "Ctrl+Z"


def test_the_readme_names_every_binding_and_no_other() -> None:
    readme = (Path(__file__).parents[2] / "README.md").read_text()
    table = readme.partition("| keys | |")[2].partition("\n\n")[0].splitlines()[2:]
    named = [key.lower() for row in table for key in row.split("|")[1].strip().split(", ")]
    keys = [binding.keys_text().lower().split(" or ")[0] for binding in BINDINGS]
    assert sorted(named) == sorted(keys)


def test_the_readme_says_which_key_is_slow() -> None:
    readme = (Path(__file__).parents[2] / "README.md").read_text()
    signs = {binding.action: binding.keys_text() for binding in BINDINGS}
    keys = f"| {signs['fly.fast']}, {signs['fly.slow']}, {signs['fly.speed']} |"
    assert f"{keys} four times faster; four times slower".lower() in readme.lower()
