"""AP-03, PP-11: an artist changes volumes, materials and lights; the gizmo; sequences.

Each edit shows in the picture and in the saved file, and undo takes it back bit for bit.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from imgui_bundle import imgui

from elemental.core.images import read_png_jpeg_webp, write_exr
from elemental.scene.volumes import Volume, rotation_rows
from elemental.ui.in_view import Lens, angles_of, outline, placed, placement
from elemental.ui.panel.sequence import left_text
from elemental.ui.sequence_job import SequenceWords
from ui.conftest import PICTURE
from ui.robot import Robot

Hands = Callable[..., Robot]
TALL = (1100, 900)


def saved(robot: Robot, path: Path) -> dict[str, object]:
    """What the file says after saving."""
    robot.desk.act("save")
    assert not robot.desk.document.unsaved, robot.desk.notices.log.entries[-1]
    return tomllib.loads(path.read_text())


def test_a_volume_is_added_overrides_and_is_undone(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Volumes", size=TALL)
    before = robot.pixels()
    robot.click("add sphere")
    assert [v.shape for v in robot.desk.document.state.volumes] == ["sphere"]
    robot.click("Place", 0.1)  # folds: room for the overrides
    robot.click("search")
    robot.type("exposure", enter=False)
    robot.click("override exposure")
    assert dict(robot.desk.document.state.volumes[0].overrides) == {"exposure": 0.25}
    assert np.array_equal(robot.pixels(), before)  # the scene's own value
    robot.enter_number("exposure", "3")
    brighter = robot.pixels()
    assert brighter.astype(int).sum() > before.astype(int).sum()
    table = saved(robot, scene_file)["volumes"][0]  # type: ignore[index]
    assert table["settings"] == {"exposure": 3.0}
    assert table["shape"] == "sphere"
    for _ in range(3):
        robot.desk.act("undo")
    assert robot.desk.document.state.volumes == ()
    assert np.array_equal(robot.pixels(), before)
    for _ in range(3):
        robot.desk.act("redo")
    assert np.array_equal(robot.pixels(), brighter)


def test_volumes_are_copied_renamed_and_deleted(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Volumes", size=TALL)
    robot.click("add box")
    robot.click("Copy")
    robot.click("name")
    robot.type("far end")
    robot.frames(2)
    names = [volume.name for volume in robot.desk.document.state.volumes]
    assert names == ["volume", "far end"]
    robot.click("volume")
    robot.click("delete")
    assert [volume.name for volume in robot.desk.document.state.volumes] == ["far end"]
    robot.desk.act("undo")
    assert len(robot.desk.document.state.volumes) == 2


def pull_gizmo(robot: Robot) -> float:
    """Pull the middle of the first volume's gizmo to the right. Returns where it was across, px."""
    desk = robot.desk
    lens = Lens.of(desk.camera, desk.stage.scene.bounds(), desk.place)
    center = np.array([desk.document.state.volumes[0].center])
    x, y, *_ = lens.lines(center, center)[0]
    robot.move(x, y)
    robot.frames()
    assert desk.wants_mouse
    robot.button(True)
    for pixels in (10, 20, 40):
        robot.move(x + pixels, y)
    robot.button(False)
    robot.frames(2)
    return x


def test_the_gizmo_moves_a_volume_in_one_step(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Volumes", size=TALL)
    desk = robot.desk
    desk.document.set_volumes((Volume("v", center=(0.0, 1.0, 0.0)),), "add v")
    robot.frames(3)
    steps = desk.document.steps
    left, right = robot.find("Scene/search")[2] + 8, robot.find("add box")[0] - 8
    assert left < pull_gizmo(robot) < right  # the ring in the middle moves across the view
    moved = desk.document.state.volumes[0].center
    assert moved[0] > 0.01
    assert moved[1] == pytest.approx(1.0, abs=0.02)
    assert desk.document.steps == steps + 1
    desk.act("undo")
    assert desk.document.state.volumes[0].center == (0.0, 1.0, 0.0)


def test_the_gizmo_scales_a_volume_in_one_step(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Volumes", size=TALL)
    desk = robot.desk
    box = Volume("v", center=(0.0, 1.0, 0.0), size=(1.0, 1.0, 1.0))
    desk.document.set_volumes((box,), "add v")
    robot.frames(2)
    robot.click("gizmo")
    robot.click("gizmo=Scale")
    steps = desk.document.steps
    pull_gizmo(robot)  # the middle scales along all axes
    size = desk.document.state.volumes[0].size
    assert size[0] > 1.1
    assert size == pytest.approx((size[0],) * 3)
    assert desk.document.state.volumes[0].center == box.center
    assert desk.document.steps == steps + 1
    table = saved(robot, scene_file)["volumes"][0]  # type: ignore[index]
    assert table["size"] == list(size)
    desk.act("undo")
    assert desk.document.state.volumes == (box,)


def test_a_material_is_changed_saved_and_undone(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Materials", size=TALL)
    before = robot.pixels()
    robot.click("material0")
    robot.drag("base_color", 0.1, -0.9)  # less red
    changed = robot.pixels()
    red = float(robot.desk.document.state.materials[0].base_color[0])
    assert red < 0.8
    assert changed[..., 0].astype(int).sum() < before[..., 0].astype(int).sum()
    table = saved(robot, scene_file)["materials"][0]  # type: ignore[index]
    assert table["name"] == "material0"
    assert table["parameters"]["base_color"][0] == pytest.approx(red)
    robot.desk.act("undo")
    assert np.array_equal(robot.pixels(), before)


def test_a_light_is_changed_saved_and_undone(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Lights", size=TALL)
    assert not robot.sees("sky.sun")  # no sky, no switch
    before = robot.pixels()
    robot.enter_number("intensity", "2.5")
    assert robot.pixels().astype(int).sum() > before.astype(int).sum()
    robot.click("heat")
    assert robot.sees("temperature")
    table = saved(robot, scene_file)["lights"][0]  # type: ignore[index]
    assert (table["intensity"], table["temperature"]) == (2.5, 6500.0)
    robot.desk.act("undo")
    robot.desk.act("undo")
    assert np.array_equal(robot.pixels(), before)


def test_the_sun_of_the_sky_is_switched_off_and_on(hands: Hands, scene_file: Path) -> None:
    radiance = np.full((64, 128, 3), 0.1, np.float32)
    radiance[10, 30] = 2e3  # a texel: 56° high
    write_exr(scene_file.with_name("sky.exr"), radiance)
    scene_file.write_text(scene_file.read_text() + '[environment]\nfile = "sky.exr"\n')
    robot = hands(scene_file, page="Lights", size=TALL)
    before = robot.pixels()
    robot.click("sky.sun")
    assert robot.setting("sky.sun") is False
    assert np.mean(robot.pixels() != before) > 0.05
    robot.desk.act("undo")
    assert np.array_equal(robot.pixels(), before)


def test_the_adapted_value_stands_over_the_histogram(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, "eye_adaptation.max_brightness=8",
                  "eye_adaptation.min_brightness=0.01", page="Exposure", size=TALL)  # fmt: skip
    robot.frames(6)
    eye = robot.desk.observers.eye
    assert eye is not None
    assert eye.histogram.shape == (64,)
    assert eye.histogram.sum() == pytest.approx(1.0, abs=1e-4)
    assert 0.01 <= eye.brightness <= 8
    assert robot.sees("histogram")


def test_a_sequence_is_rendered_stopped_and_gone_on_with(
    hands: Hands, scene_file: Path, tmp_path: Path
) -> None:
    robot = hands(scene_file, page="Sequence", size=(1100, 1000))
    desk = robot.desk
    folder = tmp_path / "made" / "frames"
    robot.click("folder")
    robot.type(str(folder))
    robot.enter_number("last", "11")
    robot.enter_number("width", "32")
    robot.enter_number("height", "18")
    robot.click("start")
    assert desk.job is not None
    while desk.job.done < 2:
        robot.frames()
    left = desk.job.seconds_left
    assert left is not None
    assert left > 0.0
    assert left_text(desk.job).endswith(" left")
    robot.click("stop")
    assert left_text(desk.job) == ""
    assert desk.job.is_over
    made = len(list(folder.glob("*.png")))
    assert 2 <= made < 12
    robot.frames(3)
    assert len(list(folder.glob("*.png"))) == made  # stopped is stopped
    robot.click("start")
    while not desk.job.is_over:
        robot.frames()
    names = sorted(path.name for path in folder.glob("*.png"))
    assert names == [f"{k:05d}.png" for k in range(12)]
    assert read_png_jpeg_webp(folder / "00011.png").shape == (18, 32, 4)
    assert desk.job.rendered == 12 - made
    assert "12 frames" in desk.notices.log.entries[-1].text


def test_a_screenshot_is_the_picture_without_the_panel(
    hands: Hands, scene_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    robot = hands(scene_file, page="Sequence", size=TALL)
    robot.click("screenshot")
    robot.frames()
    written = read_png_jpeg_webp(next(tmp_path.glob("elemental-*.png")))
    assert np.array_equal(written[..., :3], robot.pixels()[..., :3])


def test_a_picture_taken_amid_a_sequence_shows_the_desks_own_frame(
    hands: Hands, scene_file: Path, tmp_path: Path
) -> None:
    robot = hands(scene_file, page="Sequence", size=TALL)
    desk = robot.desk
    desk.pages.sequence = SequenceWords(tmp_path / "made", size=PICTURE, frames=(0, 5))
    desk.act("sequence.start")  # renders into targets of the same description
    desk.rides = False
    desk.fly.position += 0.3  # the sequence keeps the place where it began
    robot.frames(2)
    amid = robot.pixels()
    desk.act("sequence.stop")
    assert desk.job is not None
    assert 2 <= desk.job.done < 6
    assert np.array_equal(amid, robot.pixels())
    made = read_png_jpeg_webp(tmp_path / "made" / "00001.png")
    assert not np.array_equal(made[..., :3], amid[..., :3])


ANGLES = st.tuples(*[st.floats(-180, 180)] * 3)


@given(ANGLES, st.tuples(*[st.floats(0.01, 100)] * 3))
def test_a_placement_leads_back_to_the_volume(
    angles: tuple[float, float, float], size: tuple[float, float, float]
) -> None:
    volume = Volume("v", center=(1.0, -2.0, 3.0), rotation_deg=angles, size=size)
    matrix = placement(volume)
    moved = placed(volume, matrix, "Move")
    assert moved.center == volume.center
    assert np.allclose(placed(volume, matrix, "Scale").size, size, rtol=1e-4)
    rows = np.array(rotation_rows(placed(volume, matrix, "Rotate").rotation_deg))
    assert np.allclose(rows, rotation_rows(angles), atol=1e-3)
    x, y, z = np.degrees(angles_of(np.array(rotation_rows((10.0, 20.0, 30.0)))))
    assert (x, y, z) == pytest.approx((10.0, 20.0, 30.0))


def test_outlines_lie_on_the_surface() -> None:
    box = Volume("b", center=(1.0, 2.0, 3.0), rotation_deg=(10.0, 20.0, 30.0), size=(1.0, 2.0, 3.0))
    ball = Volume("s", "sphere", center=(1.0, 2.0, 3.0), radius=2.0)
    for volume in (box, ball):
        starts, ends = outline(volume, 0.5)
        for point in (*starts, *ends):
            assert 0.45 < volume.distance(point) < 0.9 if volume is box else True
            if volume is ball:
                assert volume.distance(point) == pytest.approx(0.5)
    assert len(outline(box, 0.0)[0]) == 12


def test_escape_leaves_a_field_as_it_was(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Volumes", size=TALL)
    robot.click("add box")
    robot.click("name")
    robot.type("other", enter=False)
    robot.key(imgui.Key.escape)
    robot.frames(2)
    assert robot.desk.document.state.volumes[0].name == "volume"
