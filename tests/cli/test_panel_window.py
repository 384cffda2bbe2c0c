"""AP-03: the panel in a real window under Xvfb, by key and mouse events of the X server."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cli.small_scene import write_corner
from cli.test_run import environment
from cli.xvfb import display

__all__ = ["display"]

SCENE = """[[models]]
file = "corner.gltf"  # kept

[[volumes]]
name = "hall"
center = [0.0, 1.0, 0.0]
"""
FINDER = """
import json, sys
from pathlib import Path
import numpy as np
from elemental.frame import Renderer
from elemental.session import Viewpoint, set_stage
from elemental.ui.app import App, Run
from elemental.ui.in_view import Lens
from elemental.ui.window import Window

Renderer.resize = lambda self, size: setattr(self, "size", (64, 36))  # quick on any machine
words = Run("scene.toml", (900, 600), sys.argv[1:], False, None)
stage = set_stage(words.scene, words.assignments, Viewpoint(), words.size)
app = App(Window(words.size, "elemental"), stage, words)
widgets = app.desk.workspace.widgets
widgets.items = {}
draw = app.draw

def told(size, wall_s=0.0):
    draw(size, wall_s)
    desk = app.desk
    [volume] = desk.document.state.volumes
    center = np.array([volume.center])
    lens = Lens.of(desk.camera, (desk.extent.low, desk.extent.high), desk.place)
    state = {"items": widgets.items, "exposure": desk.document.state.settings["exposure"],
             "panel": desk.shows_panel, "frame": desk.drawn, "center": volume.center,
             "gizmo": lens.lines(center, center)[0][:2]}
    Path("state.part").write_text(json.dumps(state))
    Path("state.part").replace("state.json")

app.draw = told
app.loop()
app.release()
"""
"""The window, telling after each frame where its items are and what the document says."""


class Hand:
    """An artist at the window: xdotool, and what the window tells of itself."""

    def __init__(self, folder: Path, variables: dict[str, str]) -> None:
        self.folder, self.variables = folder, variables
        found = self.act("search", "--sync", "--onlyvisible", "--name", "elemental")
        self.window = found.split()[-1]
        self.act("windowfocus", self.window)

    def act(self, *words: object) -> str:
        """Run xdotool; returns what it prints."""
        result = subprocess.run(
            ["xdotool", *map(str, words)], env=self.variables, check=True, timeout=60,
            capture_output=True, text=True,
        )  # fmt: skip
        return result.stdout

    def told(self) -> dict[str, Any]:
        """The window's newest word."""
        for _ in range(600):
            try:
                return dict(json.loads((self.folder / "state.json").read_text()))
            except (OSError, ValueError):
                time.sleep(0.05)
        raise AssertionError("the window tells nothing")

    def until(self, what: Callable[[dict[str, Any]], bool]) -> None:
        """Wait for the window to say so."""
        end = time.monotonic() + 60
        while not what(self.told()):
            assert time.monotonic() < end, self.told()
            time.sleep(0.05)

    def rest(self) -> None:
        """Let a few frames pass."""
        frame = self.told()["frame"]
        self.until(lambda told: told["frame"] > frame + 3)

    def click(self, item: str, *modifiers: str) -> None:
        """Click an item, once it has come to rest."""
        self.until(lambda told: item in told["items"])
        self.rest()
        left, top, right, bottom = self.told()["items"][item]
        x, y = int((left + right) / 2), int((top + bottom) / 2)
        self.act("mousemove", "--window", self.window, x, y)
        self.rest()
        for modifier in modifiers:
            self.act("keydown", modifier)
        self.act("mousedown", 1)
        self.rest()
        self.act("mouseup", 1)
        for modifier in modifiers:
            self.act("keyup", modifier)
        self.rest()


def drag_a_volume(hand: Hand) -> None:
    """Choose it in the tree, pull it by the middle of its gizmo, take that back, bring it back."""
    hand.click("Scene/volume hall")
    before = hand.told()["center"]
    x, y = (round(place) for place in hand.told()["gizmo"])
    hand.act("mousemove", "--window", hand.window, x, y)
    hand.rest()
    hand.act("mousedown", 1)
    for way in (15, 30):
        hand.act("mousemove", "--window", hand.window, x + way, y)
        hand.rest()
    hand.act("mouseup", 1)
    hand.until(lambda told: told["center"][0] > before[0] + 0.01)
    hand.rest()
    moved = hand.told()["center"]
    hand.act("key", "ctrl+z")
    hand.until(lambda told: told["center"] == before)
    hand.act("key", "ctrl+y")
    hand.until(lambda told: told["center"] == moved)


def edit(hand: Hand, scene: Path) -> None:
    """Search, type, take back, bring back, picture, save, hide the panel, leave."""
    hand.click("Settings/search")
    hand.act("type", "--delay", 60, "exposure")
    hand.click("Settings/exposure", "ctrl")
    hand.act("key", "ctrl+a")
    hand.act("type", "--delay", 60, "1.5")
    hand.act("key", "Return")
    hand.until(lambda told: told["exposure"] == 1.5)
    hand.rest()
    hand.act("key", "ctrl+z")
    hand.until(lambda told: told["exposure"] == 0.0)
    hand.act("key", "ctrl+y")
    hand.until(lambda told: told["exposure"] == 1.5)
    drag_a_volume(hand)
    hand.act("key", "F12")
    hand.until(lambda _: bool(list(scene.parent.glob("elemental-*.png"))))
    hand.act("key", "ctrl+s")
    hand.until(lambda told: "exposure" in scene.read_text())
    hand.act("key", "F5")
    hand.until(lambda told: told["panel"] is False)
    hand.act("key", "Escape")


@pytest.mark.skipif(shutil.which("xdotool") is None, reason="xdotool is not installed")
def test_search_type_drag_undo_save_and_hide(tmp_path: Path, display: str) -> None:
    folder = tmp_path / "work"
    folder.mkdir()
    write_corner(folder)
    scene = folder / "scene.toml"
    scene.write_text(SCENE)
    variables = environment(folder, display)
    quick = ["gi.enabled=false", "shadow.resolution=256", "bloom.intensity=0"]
    with subprocess.Popen(
        [sys.executable, "-c", FINDER, *quick], cwd=folder, env=variables,
        stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        try:
            edit(Hand(folder, variables), scene)
            _, stderr = process.communicate(timeout=60)
        finally:
            process.kill()
    assert (process.returncode, stderr) == (0, "")
    written = tomllib.loads(scene.read_text())
    assert written["settings"]["exposure"] == 1.5
    assert written["volumes"][0]["center"][0] > 0.01
    assert "# kept" in scene.read_text()
    kept = json.loads((tmp_path / "work.config" / "elemental" / "panel.json").read_text())
    assert kept["shows_panel"] is False  # for the next run
    assert "[Docking]" in kept["layout"]
    assert not list(folder.glob("*.ini"))
