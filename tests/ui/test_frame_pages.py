"""AP-03, PP-02: pages over the frame itself: timeline, graph, buffer viewer, log, scene tree."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui

import panel_cost
from elemental.core.images import read_exr
from elemental.gpu.device import Device
from elemental.ui.panel.graph import told
from elemental.ui.panel.targets import memory_facts
from ui.robot import Robot

Hands = Callable[..., Robot]


def test_the_timeline_has_a_row_for_each_pass(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Timeline")
    robot.frames(4)
    names = list(robot.desk.times.gpu.values)
    assert robot.sees(names[0])
    assert robot.sees("strip")


def test_the_graph_shows_passes_and_leads_to_a_target(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Graph", size=(1200, 800))
    robot.frames(5)
    report = robot.desk.observers.report
    assert report is not None
    first = report.passes[0]
    robot.click(first.name)
    written = next(
        report.resources[k] for k in first.writes if report.resources[k].kind == "texture"
    )
    width, height = written.size
    assert told(first, report) == f"{width}x{height} {written.format}"
    robot.click(f"writes {written.name}")
    robot.frames(4)
    look = robot.desk.pages.buffers.look
    assert look is not None
    assert look.target.name == written.name
    assert robot.sees("Buffers/picture")


def test_a_hidden_page_asks_for_nothing(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Buffers")
    robot.frames(4)
    passes = [timing.name for timing in robot.desk.device.timings]
    assert "inspect" in passes
    robot.desk.act("panel")
    robot.frames(4)
    robot.desk.device.finish()
    passes = [timing.name for timing in robot.desk.device.timings]
    assert "inspect" not in passes
    assert robot.desk.renderer.looker is None


def test_any_target_down_to_exact_values(
    hands: Hands, scene_file: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    robot = hands(scene_file, page="Buffers", size=(1200, 900))
    robot.frames(5)
    robot.click("search")
    robot.type("scene_color", enter=False)
    robot.click("scene_color")
    robot.point("picture", 0.5)
    robot.frames(4)  # values arrive some frames later
    inspector = robot.desk.observers.inspector
    assert inspector.probed is not None
    x, y = inspector.probed.texel
    robot.click("save")
    robot.frames(2)
    saved = next(tmp_path.glob("elemental-scene_color-*.exr"))
    pixels = read_exr(saved)
    height, width = pixels.shape[:2]
    assert np.array_equal(pixels[height - 1 - y, x], np.float32(inspector.probed.values[:3]))
    robot.click("Auto")
    robot.frames(3)
    look = robot.desk.pages.buffers.look
    assert look is not None
    assert (look.low, look.high) == (float(pixels.min()), float(pixels.max()))
    robot.click("channel")
    robot.click("channel=G")
    robot.click("colours")
    robot.click("colours=False colour")
    look = robot.desk.pages.buffers.look
    assert look is not None
    assert (look.channel, look.colors) == ("G", "False colour")
    robot.click("freeze")
    assert inspector.frozen
    report = robot.desk.observers.report
    assert report is not None
    assert robot.sees("memory")
    facts = dict(memory_facts(look.target, report))
    assert facts["takes"] == f"{8 * width * height / 1024:,.0f} KiB"  # half floats
    held = next(one for one in report.pool.held if f"{one.age:,}" == facts["age"])
    assert held.age > 10
    assert facts["at most"] >= facts["pool"] == f"{report.pool.bytes / 2**20:.1f} MiB"


def test_the_wheel_zooms_about_the_mouse_and_fit_goes_back(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Buffers", size=(1200, 900))
    robot.frames(5)
    robot.point("picture", 0.3)
    robot.frames(2)
    view, before = robot.desk.pages.buffers, robot.desk.pages.buffers.look
    assert before is not None
    imgui.get_io().add_mouse_wheel_event(0.0, 3.0)
    robot.frames(3)
    after = view.look
    assert after is not None
    assert after.step < 0.6 * before.step
    assert after.probe == before.probe
    robot.click("Fit")
    assert view.look is not None
    assert view.look.step == before.step


def test_the_log_tells_and_filters(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Log")
    robot.desk.say("wrote something")
    robot.desk.say("something went wrong", "error")
    robot.frames()
    assert robot.sees("wrote something")
    robot.click("note", 0.2)
    assert not robot.sees("wrote something")
    assert robot.sees("something went wrong")
    robot.click("Clear")
    assert not robot.sees("something went wrong")


def test_the_scene_tree_leads_to_cameras(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file, page="Scene")
    robot.desk.fly.position = robot.desk.fly.position + 5.0
    robot.click("camera front")
    assert np.allclose(robot.desk.fly.position, (0, 1, 4), atol=1e-5)
    assert robot.desk.pages.selection == ("camera", 0)
    assert robot.sees("material material0")
    robot.click("Materials", 0.1)
    assert not robot.sees("material material0")


def test_layouts_are_kept_and_reset(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    workspace = robot.desk.workspace
    first = robot.find("search")
    workspace.hidden.add("Log")
    kept = workspace.layout()
    assert "[Docking]" in kept
    robot.menu("View", "layout.reset")
    robot.frames(4)
    assert not workspace.hidden
    assert robot.find("search") == first


def test_keys_and_scale(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    before = robot.find("search")
    robot.menu("View", "Scale", "scale 1.5")
    robot.frames(4)
    after = robot.find("search")
    assert after[3] - after[1] > 1.3 * (before[3] - before[1])
    robot.desk.act("help")
    robot.frames()
    assert robot.desk.shows_help
    robot.desk.act("quit")
    assert not robot.desk.shows_help


def test_the_pixel_inspector_tells_what_the_picture_holds(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    desk = robot.desk
    desk.act("pixel")
    left, top, right, bottom = desk.place
    robot.move(left + 0.5 * (right - left), top + 0.3 * (bottom - top))
    robot.frames(5)
    values = desk.observers.pixel.values
    assert {"picture", "scene_color"} <= values.keys()
    x, y = values["picture"].texel
    pixels = robot.pixels()
    code = np.array(values["picture"].values) * 255
    assert np.allclose(code, pixels[pixels.shape[0] - 1 - y, x], atol=1e-3)
    desk.act("pixel")
    robot.frames(2)
    assert desk.renderer.looker is None


def test_what_is_hidden_costs_nothing(hands: Hands, scene_file: Path) -> None:
    robot = hands(scene_file)
    desk = robot.desk
    desk.act("panel")
    robot.frames(3)
    assert desk.gui.rests  # ImGui itself does not run
    assert desk.renderer.looker is None
    assert not desk.wants_mouse


def test_the_panel_costs_at_most_a_fifth_of_a_frame(
    device: Device, scene_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At the program's defaults but for a quarter of the window; tools/panel_cost.py has more."""
    robot = Robot(device, scene_file, "gi.enabled=true", "gi.resolution=64", size=(640, 360))
    cost = panel_cost.cost_of(robot.screen, 5)
    robot.screen.release()
    assert cost.share < panel_cost.LIMIT, cost
