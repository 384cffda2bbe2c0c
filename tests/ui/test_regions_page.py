"""GI-01, AP-03: regions of finer voxels are added, shaped, saved and taken back in the panel."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from elemental.scene.assemble import load_scene_file
from ui.robot import Robot

Hands = Callable[..., Robot]
SIZE = (1100, 900)
VOXELS = ("gi.enabled=true", "gi.resolution=64")
REGION = """
# Fine where it counts.
[[regions]]
min = [-0.5, 0.0, -0.5]    # the floor
max = [0.5, 1.0, 0.5]
level_offset = -1          # {comment}
"""


def leaf_levels(robot: Robot) -> set[int]:
    """Of the octree that the next frame is drawn with."""
    robot.frames(2)
    voxels = robot.desk.renderer._voxels
    assert voxels is not None
    return {int(level) for level in np.unique(voxels.octree.grid.region_levels)}


def test_a_region_is_added_refines_its_voxels_and_is_undone(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, *VOXELS, page="Regions", size=SIZE)
    desk = robot.desk
    assert leaf_levels(robot) == {6}
    robot.click("add")
    assert leaf_levels(robot) == {6, 7}
    robot.enter_number("level_offset", "-1")
    assert leaf_levels(robot) == {5, 6}
    desk.act("save")
    assert not desk.document.unsaved
    [table] = tomllib.loads(scene_file.read_text())["regions"]
    assert table["level_offset"] == -1
    assert "# a little brighter" in scene_file.read_text()
    desk.act("undo")
    desk.act("undo")
    assert leaf_levels(robot) == {6}
    desk.act("redo")
    assert leaf_levels(robot) == {6, 7}


def test_regions_of_the_file_are_shaped_copied_and_deleted(hands: Hands, scene_file: Path) -> None:
    finer = REGION.format(comment="finer").replace("-1  ", "1  ")
    with scene_file.open("a") as file:
        file.write(REGION.format(comment="coarser") + finer)
    robot = hands(scene_file, page="Regions", size=SIZE)
    desk = robot.desk
    robot.click("delete")  # the first
    desk.act("save")
    assert len(load_scene_file(scene_file).regions) == 1
    text = scene_file.read_text()
    assert "level_offset = 1  " in text
    assert "# finer" in text
    assert "# coarser" not in text
    robot.enter_number("level_offset", "2")
    robot.drag("minimum", 0.1, 0.9)  # x, far beyond the other end
    region = desk.document.state.regions[0]
    assert region.minimum[0] > -0.5
    assert (region.minimum < region.maximum).all()
    robot.click("Copy")
    desk.act("save")
    tables = tomllib.loads(scene_file.read_text())["regions"]
    assert [table["level_offset"] for table in tables] == [2, 2]
    assert "# finer" in scene_file.read_text()


def test_a_region_that_is_dragged_waits_for_the_release(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, *VOXELS, page="Regions", size=SIZE)
    robot.click("add")
    levels = leaf_levels(robot)
    left, top, right, bottom = robot.find("level_offset")
    robot.move(left + 0.7 * (right - left), (top + bottom) / 2)
    robot.button(True)
    robot.move(left + 0.02 * (right - left), (top + bottom) / 2)
    assert robot.desk.document.state.regions[0].level_offset == -2
    assert leaf_levels(robot) == levels
    robot.button(False)
    assert leaf_levels(robot) == {4 + 1, 6}


def test_reading_the_file_again_takes_its_regions_over(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, *VOXELS, page="Regions", size=SIZE)
    assert leaf_levels(robot) == {6}
    with scene_file.open("a") as file:
        file.write(REGION.format(comment="coarser"))
    robot.desk.act("reload")
    assert leaf_levels(robot) == {5, 6}
    assert robot.sees("region 1")


def test_a_region_outside_the_scene_is_told_once(hands: Hands, scene_file: Path) -> None:
    far = REGION.format(comment="far").replace("-0.5,", "90.5,").replace("[0.5", "[99.5")
    with scene_file.open("a") as file:
        file.write(far)
    robot = hands(scene_file, page="Regions", size=SIZE)
    told = [entry for entry in robot.desk.notices.log.entries if "regions[0]" in entry.text]
    assert len(told) == 1
    assert "outside the scene" in told[0].text
    assert told[0].kind == "warning"
    with pytest.raises(AssertionError):
        robot.find("region 2")
