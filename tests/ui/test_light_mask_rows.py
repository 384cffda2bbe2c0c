"""AP-03: the masks of lights are chosen, drift, are turned, saved beside the scene, and undone."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from elemental.core.images import write_png
from elemental.ui.images import Place
from ui.robot import Robot

Hands = Callable[..., Robot]
PLACE = Place("light", 0, "mask")
SIZE = (1200, 1000)


@pytest.fixture
def bars(tmp_path: Path) -> Path:
    """A blue bar beside a dark one."""
    (tmp_path / "masks").mkdir()
    path = tmp_path / "masks" / "bars.png"
    pixels = np.zeros((8, 8, 3), np.uint8)
    pixels[:, :4] = (0, 0, 255)
    write_png(path, pixels)
    return path


def first_light(path: Path) -> dict[str, object]:
    light: dict[str, object] = tomllib.loads(path.read_text())["lights"][0]
    return light


def test_a_mask_is_typed_drifts_is_saved_and_taken_back(
    hands: Hands, scene_file: Path, bars: Path
) -> None:
    written = first_light(scene_file)
    robot = hands(scene_file, page="Lights", size=SIZE)
    desk, document = robot.desk, robot.desk.document
    bare = robot.pixels()
    assert not robot.sees("mask_scroll")  # nothing to drift
    robot.enter_image(PLACE, "masks/bars.png")
    mask = document.state.lights[0].mask
    assert mask is not None
    assert mask.file == bars
    masked = robot.pixels()
    lost = bare[..., :3].astype(int) - masked[..., :3]
    assert (lost[..., 0] > 10).mean() > 0.2  # no red comes through, and little of anything
    assert lost[..., 0].sum() > 1.3 * lost[..., 2].sum()
    assert robot.sees("picture mask")
    assert document.steps == 1

    robot.enter_number("mask_size", "0.5")
    robot.drag("mask_scroll", 0.1, 0.4)
    robot.enter_number("roll", "90")
    light = document.state.lights[0]
    assert light.mask_size == 0.5
    assert light.mask_scroll[0] > 0.0
    assert light.roll == pytest.approx(math.pi / 2)
    assert document.steps == 4
    stands = robot.pixels()
    desk.clock.step()
    assert not np.array_equal(robot.pixels(), stands)  # it drifts
    desk.act("save")
    table = first_light(scene_file)
    assert (table["mask"], table["mask_size"]) == ("masks/bars.png", 0.5)
    assert table["mask_scroll"] == [pytest.approx(light.mask_scroll[0], rel=1e-6), 0.0]
    assert table["roll_deg"] == pytest.approx(90.0)
    assert not document.unsaved
    drifted = robot.pixels()
    desk.act("reload")
    assert np.array_equal(robot.pixels(), drifted)

    robot.enter_image(PLACE, "")
    document = desk.document
    assert np.array_equal(robot.pixels(), bare)
    desk.act("save")
    assert first_light(scene_file) == written  # no key of the mask stays behind
    desk.act("undo")
    assert np.array_equal(robot.pixels(), drifted)
    desk.act("redo")
    assert np.array_equal(robot.pixels(), bare)


def test_a_mask_is_looked_for_and_reset(hands: Hands, scene_file: Path, bars: Path) -> None:
    robot = hands(scene_file, page="Lights", size=SIZE)
    before = robot.pixels()
    robot.click("browse mask")
    robot.click("dialog/masks")
    robot.click("dialog/bars.png")
    robot.click("dialog/Open")
    robot.await_image(PLACE)
    assert robot.desk.document.state.lights[0].mask is not None
    robot.click("reset mask")
    assert robot.desk.document.state.lights[0].mask is None
    assert np.array_equal(robot.pixels(), before)


def test_a_bad_mask_is_told_and_changes_nothing(hands: Hands, scene_file: Path) -> None:
    (scene_file.parent / "text.png").write_bytes(b"no image")
    robot = hands(scene_file, page="Lights", size=SIZE)
    robot.enter_image(PLACE, "text.png")
    assert not robot.desk.document.steps
    assert robot.sees("problem mask")
    said = robot.desk.notices.log.entries[-1]
    assert said.kind == "error"
    assert "not a PNG, JPEG or WebP image" in said.text
    robot.click("reset mask")
    assert not robot.sees("problem mask")
