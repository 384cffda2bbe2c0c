"""AP-03: every word of the panel can be read from 960x540 up, whatever the text's size."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui

from elemental.core.paths import content_root
from elemental.gpu.device import Device
from elemental.scene.model import Region
from elemental.session import Viewpoint, set_stage
from elemental.ui.desk import Words
from elemental.ui.docking import Docking, Room
from elemental.ui.headless import HeadlessDesk
from elemental.ui.preferences import Preferences
from ui.robot import QUICK, Robot

Hands = Callable[..., Robot]
LEAST_VALUE_EM = 4.0
"""Room for the number of a slider: -12.34 EV takes 3.6."""
SLACK_PX = 1.5


MORE = """
[[lights]]
kind = "spot"
name = "a lamp over the door"
position = [-12.25, 3.0, 100.125]
direction = [0.0, -1.0, 0.0]
intensity = 1234.5
temperature = 2700.0

[[volumes]]
name = "the room behind the door"
center = [-12.25, 3.0, 100.125]
rotation_deg = [12.5, 45.0, 0.0]
settings.exposure = -1.25
settings.scene_color.tint = [0.9, 0.8, 0.7]
"""


def beyond(robot: Robot, page: str) -> list[str]:
    """Items of a page that reach over its window's borders, and sliders too narrow to read."""
    window = imgui.internal.find_window_by_name(page)
    assert window is not None
    right, em = window.inner_rect.max.x, imgui.get_style().font_size_base * robot.desk.gui.scale
    items = robot.desk.workspace.widgets.items or {}
    mine = {name: rect for name, rect in items.items() if name.startswith(f"{page}/")}
    assert mine, page
    wide = [
        name for name, rect in mine.items() if rect[2] > right + SLACK_PX and page != "Graph"
    ]  # boxes of the graph are moved by hand
    narrow = [
        f"{name} {rect[2] - rect[0]:.0f} px"
        for name, rect in mine.items()
        if "." in name and "label" not in name and name.startswith("Settings/")
        and LEAST_VALUE_EM * em > rect[2] - rect[0] > 1.6 * em
        and not name.startswith(("Settings/swatch", "Settings/browse", "Settings/reset"))
    ]  # fmt: skip
    return wide + narrow


@pytest.mark.parametrize(("size", "scale"), [((960, 540), 1.0), ((960, 540), 2.0)])
def test_nothing_is_cut(hands: Hands, device: Device, size: tuple[int, int], scale: float) -> None:
    scene = content_root() / "scenes" / "many_lights.toml"
    robot = hands(scene, page="Scene", size=size, scale=scale)
    far = np.array([-100.25, -12.125, 100.125], np.float32)
    robot.desk.document.set_regions((Region(far, far + 0.5, -2),), "add region")
    names = [page.name for page in robot.desk.workspace.pages]
    for name in names:
        robot.desk.workspace.bring_to_front(name)
        robot.frames(4)
        assert beyond(robot, name) == [], name
    left, top, right, bottom = robot.desk.place
    assert (right - left) * (bottom - top) > 0.2 * size[0] * size[1]  # the picture has its part


@pytest.mark.parametrize(("scale", "stacked"), [(1.0, False), (2.0, True)])
def test_labels_stand_above_their_values_where_pages_are_narrow(
    hands: Hands, scene_file: Path, scale: float, stacked: bool
) -> None:
    robot = hands(scene_file, size=(960, 540), scale=scale)
    robot.click("search")
    robot.type("exposure", enter=False)
    label, value = robot.find("label Exposure"), robot.find("exposure")
    assert (label[3] <= value[1] + 6.0 * scale) == stacked


def test_the_layout_follows_the_window_until_it_is_the_user_s(
    hands: Hands, scene_file: Path
) -> None:
    robot = hands(scene_file, size=(1280, 720))
    desk = robot.desk
    assert robot.sees("Scene/search")
    robot.screen.size = (640, 360)  # compact: one column
    robot.frames(12)
    assert not robot.sees("Scene/search")
    assert robot.sees("Settings/search")  # what was in front stays there
    robot.screen.size = (1280, 720)
    robot.frames(12)
    assert robot.sees("Scene/search")
    before = robot.find("Settings/search")
    robot.screen.size = (1920, 720)
    robot.frames(6)
    after = robot.find("Settings/search")
    assert after[2] - after[0] > 1.2 * (before[2] - before[0])
    kept = desk.workspace.layout()
    imgui.internal.dock_builder_dock_window("Scene", desk.workspace._docking.nodes["bottom"])
    robot.frames(6)
    robot.screen.size = (640, 360)
    robot.frames(6)
    scene = imgui.internal.find_window_by_name("Scene")
    assert scene is not None
    assert scene.dock_id == desk.workspace._docking.nodes["bottom"]
    names = [page.name for page in desk.workspace.pages]
    told = kept.partition("\n")[0].removeprefix("; workspace")
    read = Docking.read(json.loads(told), names)
    assert read is not None
    assert read.room == Room(1920.0, read.room.height, 15.0)


@pytest.mark.parametrize("size", [(1280, 720), (1600, 900), (640, 360), (300, 40), (1, 1)])
def test_a_kept_layout_opens_in_any_window(
    hands: Hands, device: Device, scene_file: Path, size: tuple[int, int]
) -> None:
    """Of another window's size, too; and lays the pages out again as large as they were."""
    robot = hands(scene_file, size=(1280, 720))
    robot.desk.workspace.bring_to_front("Graph")
    robot.frames(4)
    kept = robot.desk.preferences
    before = robot.find("Scene/search")
    robot.screen.release()
    stage = set_stage(str(scene_file), list(QUICK), Viewpoint(), size)
    screen = robot.screen = HeadlessDesk(
        device, stage, Words(str(scene_file), list(QUICK)), size, records=True, preferences=kept
    )
    robot.desk = screen.desk
    robot.frames(8)
    if size == (1280, 720):
        assert robot.find("Scene/search") == before
        assert robot.sees("Graph/canvas")  # which was in front
        assert robot.sees("Settings/search")
    if size == (1600, 900):
        assert robot.find("Scene/search")[2] > 1.1 * before[2]
    robot.screen.size = (1280, 720)
    robot.frames(12)
    assert robot.sees("Scene/search")


BROKEN = (
    "[]", "3", '{"room": [0, 0, 0]}', '{"room": ["a"]}', '{"room": [9, 9, 1]}',
    '{"room": [9, 9, 1], "nodes": {"up": 1}, "pages": {}}',
)  # fmt: skip


@pytest.mark.parametrize("text", BROKEN)
def test_a_broken_layout_s_head_costs_nothing(text: str) -> None:
    assert Docking.read(json.loads(text), []) is None


HEADS = (
    "", "; workspace", "; workspace {", "; workspace [3]", '; workspace {"front": 3}',
    '; workspace {"front": ["No"]}',
)  # fmt: skip


@pytest.mark.parametrize("head", HEADS)
def test_a_broken_kept_layout_opens(
    hands: Hands, device: Device, scene_file: Path, head: str
) -> None:
    stage = set_stage(str(scene_file), list(QUICK), Viewpoint(), (640, 360))
    words = Words(str(scene_file), list(QUICK))
    kept = Preferences(layout=f"{head}\n[Window][Scene]\nPos=1,2\nSize=no\n")
    screen = HeadlessDesk(device, stage, words, (640, 360), preferences=kept)
    for _ in range(3):
        screen.draw()
    screen.release()


def test_the_first_frame_tells_no_time(hands: Hands, device: Device, scene_file: Path) -> None:
    assignments = list(QUICK)
    stage = set_stage(str(scene_file), assignments, Viewpoint(), (640, 360))
    screen = HeadlessDesk(device, stage, Words(str(scene_file), assignments), (640, 360))
    desk = screen.desk
    assert desk.times.frame_ms is None
    assert len(desk.times.history) == 0
    screen.draw()
    assert desk.times.frame_ms is None  # nothing has been measured yet
    assert not desk.times.history.size
    assert desk.times.panel_ms is not None
    screen.draw()
    assert desk.times.frame_ms is not None
    assert desk.times.history.tolist() == [pytest.approx(desk.times.frame_ms)]
    screen.release()


def test_one_headless_frame_has_times_messages_and_a_target(
    hands: Hands, device: Device, scene_file: Path, tmp_path: Path
) -> None:
    """``shot --ui`` of one frame: what is known after it stands in its panel."""
    (tmp_path / "broken.glsl").write_text(
        '/*\nhelp = "b"\n*/\nvoid material(inout Surface s, MaterialInput m, Parameters p) {\n'
        "    s.albedo = vec3(nothing);\n}\n"
    )
    scene_file.write_text(
        scene_file.read_text() + '\n[[materials]]\nname = "*"\nshader = "broken.glsl"\n'
    )
    assignments = list(QUICK)
    stage = set_stage(str(scene_file), assignments, Viewpoint(), (960, 540))
    screen = HeadlessDesk(
        device, stage, Words(str(scene_file), assignments), (960, 540), records=True
    )
    desk = screen.desk
    desk.workspace.bring_to_front("Buffers")
    screen.draw()
    screen.finish()
    items = desk.workspace.widgets.items or {}
    assert desk.times.gpu.values
    assert desk.notices.log.count("error") >= 1
    assert desk.observers.inspector.found
    assert "Buffers/picture" in items
    assert desk.observers.inspector.picture is not None
    screen.release()


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_what_opens_over_the_picture_fits_the_window(
    hands: Hands, scene_file: Path, scale: float
) -> None:
    robot = hands(scene_file, size=(960, 540), scale=scale)
    desk = robot.desk
    broken = "content/materials/rust.glsl:12: 'nothing': undeclared identifier, and so on, and on"
    robot.desk.renderer.problems = lambda: [broken * 2]

    def extent(name: str) -> tuple[float, float, float, float]:
        window = imgui.internal.find_window_by_name(name)
        assert window is not None
        return (window.pos.x, window.pos.y,
                window.pos.x + window.size.x, window.pos.y + window.size.y)  # fmt: skip

    for action, name in (("help", "keys"), ("hud", "hud")):
        desk.act(action)
        robot.frames(4)
        left, top, right, bottom = extent(name)
        assert left >= 0
        assert top >= 0
        assert right <= 960
        assert bottom <= 540 or name == "hud"
        desk.act(action)
    desk.act("save.as")
    robot.frames(4)
    for button in ("dialog/Save", "dialog/Cancel", "dialog/name"):
        assert robot.find(button)[3] < 540
    robot.click("dialog/Cancel")
    desk.say("a message of many words, longer than the picture is wide, " * 3, "error")
    robot.frames(4)
    left, _, right, _ = extent("message")
    assert left >= desk.place[0]
    assert right <= desk.place[2]


def test_the_keys_leave_the_panel_at_work(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, size=(1600, 900))
    robot.desk.act("help")
    robot.frames(3)
    robot.click("search")
    robot.type("exposure", enter=False)
    robot.enter_number("exposure", "1.5")
    assert robot.setting("exposure") == 1.5


def test_an_override_goes_back_to_the_scene_s_value(hands: Hands, scene_file: Path) -> None:
    scene_file.write_text(scene_file.read_text() + MORE)
    robot = hands(scene_file, page="Volumes", size=(1200, 1000))
    robot.click("search")
    robot.type("exposure", enter=False)
    assert robot.desk.document.state.volumes[0].overrides["exposure"] == -1.25
    robot.click("reset exposure")
    assert robot.desk.document.state.volumes[0].overrides["exposure"] == 0.25  # the scene's
    robot.frames(2)
    assert not robot.sees("reset exposure")
