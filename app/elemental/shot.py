"""``elemental shot``: the frame as a file, headless, the same every time."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from elemental import __version__
from elemental.core.errors import InputError
from elemental.frame import VIEWS, Frame, Renderer
from elemental.picture import SUFFIXES, save_picture
from elemental.report import (
    SCHEMA,
    PassEntry,
    Report,
    bytes_entry,
    driver_entry,
    overflow_warnings,
    say,
    scene_entry,
    settings_entry,
    write_json,
)
from elemental.session import (
    FRAME_NUMBER,
    Point,
    Stage,
    Viewpoint,
    check_output,
    frame_file,
    headless_device,
    known_name,
    set_stage,
)


@dataclass(frozen=True)
class Shot:
    """The words of one ``elemental shot``: pixels, seconds, metres and degrees."""

    scene: str | None
    output: Path
    size: tuple[int, int]
    frames: int
    fps: float
    time: float
    seed: int
    camera: str | None
    eye: Point | None
    target: Point | None
    fov: float | None
    view: str
    assignments: list[str]
    report: Path | None
    ui: bool = False
    ui_page: str | None = None


def shoot(shot: Shot) -> None:
    """Render frames 0 to N-1, 1/fps apart in scene time, and write the last one.

    An output name with a frame number (``out.%04d.png``) gets each frame. Everything that can be
    refused is refused before the first frame. Raises InputError.
    """
    check_output("-o", frame_file(shot.output, shot.frames - 1), SUFFIXES)
    if shot.report is not None:
        check_output("--report", shot.report, (".json",))
    known_name("--view", shot.view, list(VIEWS))
    viewpoint = Viewpoint(shot.camera, shot.eye, shot.target, shot.fov)
    stage = set_stage(shot.scene, shot.assignments, viewpoint, shot.size)
    if shot.ui or shot.ui_page is not None:
        _shoot_panel(shot, stage)
        return
    device = headless_device()
    renderer = Renderer(device, stage.scene, stage.settings, shot.size)
    is_sequence = FRAME_NUMBER.search(shot.output.name) is not None
    for index in range(shot.frames):
        began = time.perf_counter()
        time_s = shot.time + index / shot.fps
        frame = renderer.render(stage.camera_at(time_s), time_s, index, shot.view)
        device.finish()
        wall_ms = 1e3 * (time.perf_counter() - began)
        if is_sequence or index == shot.frames - 1:
            file = frame_file(shot.output, index)
            save_picture(file, renderer.read(frame), frame.is_linear)
    report = _report(shot, stage, renderer, frame, wall_ms)
    if shot.report is not None:
        write_json(shot.report, report)
    say(report["warnings"], report["notes"])
    print(frame_file(shot.output, shot.frames - 1))


def _shoot_panel(shot: Shot, stage: Stage) -> None:
    """The same pictures as an artist sees them, the panel around the scene."""
    from elemental.ui.desk import Words  # noqa: PLC0415 (ImGui takes 200 ms to import)
    from elemental.ui.headless import HeadlessDesk  # noqa: PLC0415

    if shot.output.suffix.lower() != ".png":
        raise InputError("-o", str(shot.output), "a picture with the panel is a .png")
    if shot.report is not None:
        raise InputError("--report", str(shot.report), "not together with --ui")
    screen = HeadlessDesk(headless_device(), stage, Words(shot.scene, shot.assignments), shot.size)
    desk = screen.desk
    desk.view, desk.rides = shot.view, stage.camera_moves
    if shot.ui_page is not None:
        pages = [page.name for page in desk.workspace.pages]
        desk.workspace.bring_to_front(known_name("--ui-page", shot.ui_page, pages))
    is_sequence = FRAME_NUMBER.search(shot.output.name) is not None
    for index in range(shot.frames):
        desk.clock.time_s = shot.time + index / shot.fps
        screen.draw()
        desk.device.finish()
        if is_sequence or index == shot.frames - 1:
            screen.finish()
            save_picture(frame_file(shot.output, index), screen.read(), False)
    say([*stage.scene.warnings, *desk.renderer.problems()], stage.scene.notes)
    print(frame_file(shot.output, shot.frames - 1))


def _report(shot: Shot, stage: Stage, renderer: Renderer, frame: Frame, wall_ms: float) -> Report:
    device = renderer.device
    passes = [PassEntry(name=t.name, gpu_ms=t.gpu_ms, cpu_ms=t.cpu_ms) for t in device.timings]
    counters = {name: int(count) for name, count in frame.counters.items()}
    return {
        "schema": SCHEMA,
        "elemental": __version__,
        "scene": scene_entry(stage.scene),
        "view": shot.view,
        "size": list(shot.size),
        "frames": shot.frames,
        "time_s": shot.time,
        "seed": shot.seed,
        "settings": settings_entry(stage.settings),
        "gl": driver_entry(device),
        "passes": passes,
        "frame": {
            "gpu_ms": sum(entry["gpu_ms"] for entry in passes),
            "cpu_ms": sum(entry["cpu_ms"] for entry in passes),
            "wall_ms": wall_ms,
        },
        "counters": counters,
        "bytes": bytes_entry(device),
        "gl_messages": [str(message) for message in device.messages],
        "warnings": [*stage.scene.warnings, *renderer.problems(), *overflow_warnings(counters)],
        "notes": list(stage.scene.notes),
    }
