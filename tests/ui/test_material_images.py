"""AP-03: images of materials are chosen in the panel, saved as paths beside the scene, undone."""

from __future__ import annotations

import threading
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from elemental.core.images import write_png
from elemental.scene.materials import Texture
from elemental.ui import images
from elemental.ui.images import Place
from ui.robot import Robot

Hands = Callable[..., Robot]
ROW = "base_color_texture"
PLACE = Place("material", 0, ROW)
SIZE = (1200, 1000)


@pytest.fixture
def blue(tmp_path: Path) -> Path:
    """A blue image in a folder beside the scene."""
    (tmp_path / "images").mkdir()
    path = tmp_path / "images" / "blue.png"
    write_png(path, np.full((4, 8, 3), (20, 40, 230), np.uint8))
    return path


def test_an_image_is_typed_saved_beside_the_scene_and_taken_back(
    hands: Hands, scene_file: Path, blue: Path
) -> None:
    robot = hands(scene_file, page="Materials", size=SIZE)
    bare = robot.pixels()
    robot.enter_image(PLACE, "images/blue.png")
    document = robot.desk.document
    slot = document.state.materials[0].base_color_texture
    assert slot is not None
    assert robot.desk.stage.scene.textures[slot.texture].file == blue
    worn = robot.pixels()
    dyed = (bare.astype(int) - worn)[..., 0] > 20  # the floor's pixels lose their red
    assert dyed.mean() > 0.02
    assert (worn[dyed, 2] > 2 * worn[dyed, 0]).mean() > 0.9
    assert robot.sees(f"picture {ROW}")
    assert document.steps == 1
    robot.desk.act("undo")
    assert np.array_equal(robot.pixels(), bare)
    robot.desk.act("redo")
    assert np.array_equal(robot.pixels(), worn)
    robot.desk.act("save")
    table = tomllib.loads(scene_file.read_text())["materials"]
    assert table == [{"name": "material0", "parameters": {ROW: "images/blue.png"}}]
    assert not document.unsaved
    robot.desk.act("reload")
    assert np.array_equal(robot.pixels(), worn)
    robot.enter_image(PLACE, "")
    assert np.array_equal(robot.pixels(), bare)
    robot.desk.act("save")
    table = tomllib.loads(scene_file.read_text())["materials"]
    assert table[0]["parameters"] == {ROW: "white"}
    robot.desk.act("reload")
    assert np.array_equal(robot.pixels(), bare)


def test_an_image_is_looked_for(hands: Hands, scene_file: Path, blue: Path) -> None:
    robot = hands(scene_file, page="Materials", size=SIZE)
    robot.click(f"browse {ROW}")
    assert robot.desk.dialog is not None
    assert not robot.sees("dialog/scene.toml")  # only images are listed
    robot.click("dialog/images")
    robot.click("dialog/blue.png")
    robot.click("dialog/Open")
    robot.await_image(PLACE)
    slot = robot.desk.document.state.materials[0].base_color_texture
    assert slot is not None
    assert robot.desk.stage.scene.textures[slot.texture].name == "blue"
    robot.click(f"reset {ROW}")
    assert robot.desk.document.state.materials[0].base_color_texture is None


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("nothing.png", None, "does not exist"),
        ("text.png", b"no image", "not a PNG, JPEG or WebP image"),
        (".", None, "is a folder"),
    ],
)
def test_a_bad_file_is_told_and_changes_nothing(
    hands: Hands,
    scene_file: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    content: bytes | None,
    reason: str,
) -> None:
    if content is not None:
        (scene_file.parent / name).write_bytes(content)
    robot = hands(scene_file, page="Materials", size=SIZE)
    robot.enter_image(PLACE, name)
    assert not robot.desk.document.steps
    assert robot.sees(f"problem {ROW}")
    said = robot.desk.notices.log.entries[-1]
    assert said.kind == "error"
    assert str(scene_file.parent) in said.text
    assert reason in said.text
    monkeypatch.setattr(robot.desk.device, "largest_texture_px", 4)
    write_png(scene_file.parent / "wide.png", np.zeros((1, 8, 3), np.uint8))
    robot.enter_image(PLACE, "wide.png")
    assert "is 8x1; this driver takes 4 pixels a side" in robot.desk.notices.log.entries[-1].text
    robot.click(f"reset {ROW}")
    assert not robot.sees(f"problem {ROW}")


def test_whatever_reading_raises_is_told(
    hands: Hands, scene_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(path: Path) -> Texture:
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(images, "read_texture", broken)
    robot = hands(scene_file, page="Materials", size=SIZE)
    robot.enter_image(PLACE, "blue.png")
    assert robot.sees(f"problem {ROW}")
    assert (
        "blue.png: can't be read (can't start new thread)"
        in robot.desk.notices.log.entries[-1].text
    )


def test_frames_go_on_while_a_file_is_read(
    hands: Hands, scene_file: Path, blue: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gate = threading.Event()
    read = images.read_texture

    def slow(path: Path) -> Texture:
        assert gate.wait(30)
        return read(path)

    monkeypatch.setattr(images, "read_texture", slow)
    robot = hands(scene_file, page="Materials", size=SIZE)
    robot.click(ROW)
    robot.type("images/blue.png")
    drawn = robot.desk.drawn
    robot.frames(3)
    assert robot.desk.drawn == drawn + 3
    assert robot.desk.images.is_reading(PLACE)
    gate.set()
    robot.await_image(PLACE)
    assert robot.desk.document.state.materials[0].base_color_texture is not None


def test_a_scene_that_is_read_again_keeps_the_images(
    hands: Hands, scene_file: Path, blue: Path
) -> None:
    """Settings that the scene is read by come between two choices."""
    robot = hands(scene_file, page="Materials", size=SIZE)
    robot.enter_image(PLACE, "images/blue.png")
    worn = robot.pixels()
    robot.desk.document.set("scene.animation", "none")
    robot.frames(3)
    assert np.array_equal(robot.pixels(), worn)
    while robot.desk.document.undo():
        robot.frames()
    assert not robot.desk.document.state.materials[0].base_color_texture
