"""AP-03: an artist changes settings by mouse and keyboard; undo, redo, reset, save and revert."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
from imgui_bundle import imgui

from elemental.settings import SETTINGS
from elemental.ui.panel.settings import GROUPS
from ui.robot import Robot

Hands = Callable[..., Robot]


def find(robot: Robot, text: str) -> None:
    """Search for a setting."""
    robot.click("search")
    robot.type(text, enter=False)


def test_a_drag_changes_the_picture_and_is_one_step(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    before = robot.pixels()
    find(robot, "exposure")
    robot.drag("exposure", 0.5, 0.6, steps=6)
    assert robot.setting("exposure") > 1.0
    changed = robot.pixels()
    assert changed.astype(int).sum() > before.astype(int).sum()
    assert robot.desk.document.steps == 1
    robot.menu("undo")
    assert robot.setting("exposure") == 0.25
    assert np.array_equal(robot.pixels(), before)  # bit for bit
    robot.menu("redo")
    assert np.array_equal(robot.pixels(), changed)


def test_numbers_are_typed_and_kept_in_range(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    find(robot, "exposure")
    robot.enter_number("exposure", "1.35")
    assert robot.setting("exposure") == 1.35  # not 1.35000002384185791015625
    robot.enter_number("exposure", "99")
    assert robot.setting("exposure") == SETTINGS["exposure"].hi


def test_ticks_choices_texts_and_colours(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    find(robot, "fxaa")
    robot.click("fxaa.enabled")
    assert robot.setting("fxaa.enabled") is False
    find(robot, "shadow resolution")
    robot.click("shadow.resolution")
    robot.click("shadow.resolution=512")
    assert robot.setting("shadow.resolution") == 512
    find(robot, "indirect color")
    robot.drag("indirect.color", 0.1, -1.0)
    red, green, blue = robot.setting("indirect.color")
    assert red < 1.0
    assert (green, blue) == (1.0, 1.0)
    find(robot, "sky.image")
    robot.click("sky.image")
    robot.type("nowhere.exr")
    robot.frames(2)
    assert robot.setting("sky.image") == ""  # refused: there is no such file
    assert "nowhere.exr" in robot.desk.notices.log.entries[-1].text
    assert robot.desk.document.steps == 3


def test_what_is_not_by_default_is_marked_and_reset(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    find(robot, "exposure")
    assert robot.sees("reset exposure")
    robot.click("reset exposure")
    assert robot.setting("exposure") == 0.0
    robot.frames()
    assert not robot.sees("reset exposure")


def test_save_keeps_comments_and_revert_goes_back(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, "exposure=0.25")
    document = robot.desk.document
    find(robot, "exposure")
    robot.enter_number("exposure", "2")
    assert document.unsaved
    robot.menu("File", "save")
    assert not document.unsaved
    text = scene_file.read_text()
    assert tomllib.loads(text)["settings"]["exposure"] == 2.0
    for comment in ("# A corner, lit from above.", "# enough for a corner", "# beside this file"):
        assert comment in text
    robot.enter_number("exposure", "3")
    assert document.unsaved
    robot.menu("File", "revert")
    assert robot.setting("exposure") == 2.0
    assert not document.unsaved
    robot.menu("undo")  # reverting is a step too
    assert robot.setting("exposure") == 3.0


def test_save_as_asks_for_a_name_and_before_it_overwrites(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    find(robot, "exposure")
    robot.enter_number("exposure", "1")
    robot.menu("File", "save.as")
    robot.click("dialog/name")
    robot.type("other")
    robot.frames(2)
    other = scene_file.with_name("other.toml")
    assert tomllib.loads(other.read_text())["settings"]["exposure"] == 1.0
    assert tomllib.loads(scene_file.read_text())["settings"]["exposure"] == 0.25
    assert robot.desk.stage.scene.path == other
    robot.menu("File", "save.as")
    robot.click("dialog/scene.toml")
    robot.click("dialog/Save")
    assert tomllib.loads(scene_file.read_text())["settings"]["exposure"] == 0.25
    robot.click("dialog/Save")  # asked again
    assert tomllib.loads(scene_file.read_text())["settings"]["exposure"] == 1.0


def test_keys_undo_and_save(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    find(robot, "exposure")
    robot.enter_number("exposure", "1")
    robot.desk.act("undo")
    assert robot.setting("exposure") == 0.25
    robot.desk.act("undo", shift=True)
    assert robot.setting("exposure") == 1.0
    robot.desk.act("save")
    assert not robot.desk.document.unsaved


def test_every_setting_is_found_by_its_key(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    last = list(SETTINGS)[-1]
    find(robot, last)
    assert robot.desk.pages.settings == last
    assert robot.sees(last)
    robot.key(imgui.Key.escape)
    for key in SETTINGS:
        robot.desk.pages.settings = key  # as if typed, which takes frames
        robot.frames()
        assert robot.sees(key), key
    assert sum(map(len, GROUPS.values())) == len(SETTINGS)


def test_a_rebuild_waits_until_the_slider_is_let_go(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    find(robot, "shadow.cascades")
    robot.point("shadow.cascades", 0.6)
    robot.button(True)
    left, top, right, bottom = robot.find("shadow.cascades")
    robot.move(left + 0.05 * (right - left), (top + bottom) / 2)
    robot.frames(2)
    assert robot.setting("shadow.cascades") == 1
    assert robot.desk.renderer.settings["shadow.cascades"] == 3
    robot.button(False)
    robot.frames(2)
    assert robot.desk.renderer.settings["shadow.cascades"] == 1


def test_the_default_sun_comes_and_goes(hands: Hands, scene_file: Path) -> None:
    unlit = scene_file.with_name("unlit.toml")
    unlit.write_text('[[models]]\nfile = "corner.gltf"\n[[materials]]\nname = "*"\n'
                     "parameters = { emissive = [0.0, 0.0, 0.0] }\n")  # fmt: skip
    robot = hands(unlit)
    before = robot.pixels()
    assert [light.name for light in robot.desk.document.state.lights] == ["default sun"]
    robot.desk.document.set("scene.default_lights", "off")
    robot.frames(2)
    assert robot.desk.document.state.lights == ()
    assert robot.pixels()[..., :3].max() < before[..., :3].max()
    robot.desk.act("undo")
    robot.frames(2)
    assert np.array_equal(robot.pixels(), before)


def test_a_file_is_found_by_a_dialog(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    looks = scene_file.parent / "looks"
    looks.mkdir()
    lines = "\n".join(f"{r} {g} {b}" for b in (0, 1) for g in (0, 1) for r in (0, 1))
    (looks / "plain.cube").write_text(f"LUT_3D_SIZE 2\n{lines}\n")
    (looks / "notes.txt").write_text("no look")
    find(robot, "color_grading.lut")
    robot.click("browse color_grading.lut")
    robot.frames(2)
    robot.click("dialog/looks")
    robot.frames(2)
    assert not robot.sees("dialog/notes.txt")
    robot.click("dialog/plain.cube")
    robot.click("dialog/Open")
    robot.frames(2)
    assert robot.setting("color_grading.lut") == "looks/plain.cube"  # from the scene's folder
    robot.desk.act("undo")
    assert robot.setting("color_grading.lut") == ""


def test_unsaved_edits_are_dropped_only_when_asked_twice(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    asked: list[str] = []
    robot.desk.window_acts = asked.append
    robot.desk.document.set("exposure", 2.0)
    robot.desk.act("reload")
    assert robot.setting("exposure") == 2.0
    assert "unsaved" in robot.desk.notices.message
    robot.desk.act("reload")
    assert robot.setting("exposure") == 0.25
    robot.desk.act("quit")
    assert asked == ["quit"]
    assert robot.desk.may_lose_edits("Esc")  # nothing is unsaved any more
