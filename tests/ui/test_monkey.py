"""AP-03: thoughtless hands: clicks, pulls and keys anywhere; nothing breaks, all can be undone."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui

from ui.robot import Robot

Hands = Callable[..., Robot]

ACTIONS = 150
LEFT_ALONE = {"menu/screenshot", "menu/close", "menu/reload", "menu/save",
              "Sequence/screenshot", "Sequence/start", "Buffers/save"}  # fmt: skip
"""What writes files, leaves, or forgets the history."""
VERBS = (
    "undo", "redo", "pause", "step", "hud", "help", "pixel", "view.next", "panel", "quit", "revert",
    "layout.reset", "scale 1.25", "scale 1.0", "page Volumes", "page Materials", "page Lights",
    "page Regions", "page Settings", "page Graph", "page Buffers", "page Exposure", "page Sequence",
    "page Log",
)  # fmt: skip
KEYS = (imgui.Key.enter, imgui.Key.escape, imgui.Key.tab, imgui.Key.backspace)


@pytest.mark.parametrize("seed", [2, 3])
def test_nothing_breaks_and_all_can_be_undone(hands: Hands, scene_file: Path, seed: int) -> None:
    dice = random.Random(seed)
    robot = hands(scene_file)
    desk, io = robot.desk, imgui.get_io()
    before = robot.pixels()
    for _ in range(ACTIONS):
        items = [name for name in desk.workspace.widgets.items or {} if name not in LEFT_ALONE]
        throw = dice.random()
        if throw < 0.6 and items and desk.shows_panel:
            robot.point(dice.choice(items), dice.random())
            robot.button(True)
            if dice.random() < 0.4:
                robot.move(dice.uniform(0, 1000), dice.uniform(0, 640))
            robot.button(False)
        elif throw < 0.75:
            io.add_input_characters_utf8(dice.choice(["1", "x", "-", "0.5", "é", "name"]))
            robot.key(dice.choice(KEYS))
        else:
            desk.act(dice.choice(VERBS))
            robot.frames()
    robot.desk.device.check()
    desk.dialog = None
    while desk.document.undo():
        pass
    desk.view = "final"
    desk.act("camera.home")
    desk.clock.time_s = 0.0
    robot.frames(3)
    assert not desk.document.unsaved or desk.document.state.settings != desk.document.saved.settings
    assert np.array_equal(robot.pixels(), before)
