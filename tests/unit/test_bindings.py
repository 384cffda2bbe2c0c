"""The table of bindings: complete, without clashes, each key known to GLFW."""

from __future__ import annotations

import subprocess
import sys

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
