"""What each action of a key or a menu does to the desk."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from elemental.core.errors import InputError
from elemental.core.images import write_exr
from elemental.core.paths import named_file
from elemental.passes.inspect import Target
from elemental.passes.texels import Pixels
from elemental.picture import save_picture
from elemental.scene.evaluate import placed_camera
from elemental.scene.save_names import name_in
from elemental.ui import editor, reopening
from elemental.ui.panel import buffers
from elemental.ui.panel.file_dialog import FileDialog
from elemental.ui.panel.scene import Selection
from elemental.ui.panel.targets import targets_of
from elemental.ui.sequence_job import SequenceJob, staged

if TYPE_CHECKING:
    from elemental.ui.desk import Desk

IMAGES = (".png", ".jpg", ".jpeg", ".webp", ".exr", ".hdr")
FILE_SUFFIXES = {"sky.image": (".hdr", ".exr"), "color_grading.lut": (".cube",)}
"""Of the files that a setting takes, where not any image."""
PAGE_OF = {
    "volume": "Volumes", "light": "Lights", "material": "Materials", "region": "Regions",
}  # fmt: skip
"""The page on which a kind of thing is changed."""


def act(desk: Desk, action: str, index: int = 0, shift: bool = False) -> bool:
    """Do it; ``index`` tells which of the binding's keys. Returns False for what a window does."""
    verb, _, word = action.partition(" ")
    return (
        _act_on_picture(desk, verb, word, index, shift)
        or _act_on_document(desk, action, shift)
        or _act_on_panel(desk, verb, word)
    )


def _act_on_picture(desk: Desk, verb: str, word: str, index: int, shift: bool) -> bool:
    match verb:
        case "camera.pick":
            _pick_camera(desk, index)
        case "camera.home":
            desk.rides = desk.stage.camera_moves
            desk.fly.jump(desk.stage.camera)
        case "screenshot":
            _screenshot(desk)
        case "sequence.start":
            _start_sequence(desk)
        case "sequence.stop" if desk.job is not None:
            desk.job.stop()
        case "reload":
            if desk.may_lose_edits("R"):
                reopening.reload(desk)
        case "view.next":
            desk.next_view(-1 if shift else 1)
        case "view":
            desk.show_view(word)
        case "pause":
            desk.clock.toggle()
            desk.say("paused" if desk.clock.paused else "playing")
        case "step":
            desk.clock.step()
        case _:
            return False
    return True


def _act_on_document(desk: Desk, action: str, shift: bool) -> bool:
    document = desk.document
    match action:
        case "undo" if not shift:
            label = document.undo()
            desk.say(f"took back: {label}" if label else "nothing to take back")
        case "undo" | "redo":
            label = document.redo()
            desk.say(f"brought back: {label}" if label else "nothing to bring back")
        case "save" if not shift and desk.stage.scene.path.suffix.lower() == ".toml":
            save_to(desk, desk.stage.scene.path)
        case "save" | "save.as":
            start = editor.default_target(desk.stage.scene).resolve()
            desk.dialog = FileDialog("Save the scene as", start, (".toml",), True, desk.save_to)
        case "revert":
            document.revert()
        case _:
            return False
    return True


def _act_on_panel(desk: Desk, verb: str, word: str) -> bool:
    workspace = desk.workspace
    match verb:
        case "help":
            desk.shows_help = not desk.shows_help
        case "quit" if desk.shows_help:
            desk.shows_help = False
        case "panel":
            desk.shows_panel = not desk.shows_panel
        case "pixel":
            desk.shows_pixel = not desk.shows_pixel
        case "hud":
            desk.shows_hud = not desk.shows_hud
        case "toggle" if word in workspace.hidden:
            workspace.bring_to_front(word)
        case "toggle":
            workspace.hidden.add(word)
        case "page":
            workspace.bring_to_front(word)
        case "layout.reset":
            workspace.reset_layout()
        case "scale":
            desk.gui.scale = float(word)
        case _:
            return False
    return True


def save_to(desk: Desk, path: Path) -> None:
    """Write the document; from then on it is that file's."""
    scene = desk.stage.scene
    try:
        editor.save(desk.document, scene, path)
    except InputError as error:
        desk.say(str(error), "error")
        return
    desk.open_saved(path)
    desk.say(f"saved {path}")


def _pick_camera(desk: Desk, index: int) -> None:
    cameras = desk.stage.scene.cameras
    if index < len(cameras):
        desk.rides = False
        desk.fly.jump(placed_camera(desk.stage.scene, cameras[index], desk.clock.time_s))
        desk.say(f"camera {index + 1}: {cameras[index].name}")
    else:
        desk.say(f"the scene has {len(cameras)} cameras")


def _screenshot(desk: Desk) -> None:
    if desk.frame is None:
        return
    stamp = time.strftime("%Y%m%d-%H%M%S")
    path = Path(f"elemental-{stamp}-{desk.drawn}.png").resolve()
    try:
        save_picture(path, desk.renderer.read(desk.frame), desk.frame.is_linear)
    except InputError as error:
        desk.say(str(error), "error")
    else:
        desk.say(f"wrote {path}")


def browse(desk: Desk) -> None:
    """Open the dialog in which a row's file is chosen."""
    widgets = desk.workspace.widgets
    asked, widgets.browsing = widgets.browsing, None
    if asked is None:
        return
    key, setting, value, base = asked
    folder = desk.stage.scene.folder.resolve() if base is None else base.resolve()
    start = named_file(value, folder)
    if not start.exists():
        start = folder

    def take(path: Path) -> None:
        widgets.browsed[key] = name_in(folder, path) if base is None else str(path)

    suffixes = FILE_SUFFIXES.get(setting.key, IMAGES)
    desk.dialog = FileDialog(f"Choose a file: {setting.key}", start, suffixes, False, take)


def _start_sequence(desk: Desk) -> None:
    camera = None if desk.rides else desk.camera
    stage = staged(desk.stage, desk.document.state.settings, camera)
    words = replace(desk.pages.sequence, view=desk.view)
    try:
        desk.job = SequenceJob(desk.device, stage, words)
    except InputError as error:
        desk.say(str(error), "error")


def advance_job(desk: Desk, job: SequenceJob) -> None:
    """Make one more frame of a sequence; tell when it is over."""
    if job.is_over:
        return
    try:
        job.advance()
    except InputError as error:
        desk.say(str(error), "error")
        return
    if job.is_over:
        desk.say(f"{job.done} frames in {job.folder.resolve()}, {job.rendered} of them new")


def choose(desk: Desk, selection: Selection) -> None:
    """Show something of the scene where it can be changed; go to a camera."""
    desk.pages.selection = selection
    kind, index = selection
    if kind == "volume":
        desk.pages.volumes.chosen = index
    elif kind == "region":
        desk.pages.regions.chosen = index
    elif kind in ("material", "light"):
        setattr(desk.pages, kind, index)
    if kind == "camera":
        _pick_camera(desk, index)
    elif PAGE_OF.get(kind) in [page.name for page in desk.workspace.pages]:
        desk.workspace.bring_to_front(PAGE_OF[kind])


def look_at(desk: Desk, name: str) -> None:
    """Show a target of the frame in the buffer viewer."""
    report = desk.observers.report
    for target, _ in targets_of(report) if report is not None else ():
        if target.name == name:
            buffers.choose(desk.pages.buffers, target)
            desk.workspace.bring_to_front("Buffers")
            return


def save_buffer(desk: Desk, target: Target, pixels: Pixels) -> None:
    """Write a target's values as EXR into the working directory, in three channels or four."""
    channels = pixels.shape[2]
    if channels == 1:
        pixels = pixels.repeat(3, axis=2)
    elif channels == 2:
        pixels = np.concatenate([pixels, np.zeros_like(pixels[..., :1])], axis=2)
    path = Path(f"elemental-{target.name.replace('/', '-')}-{desk.drawn}.exr").resolve()
    try:
        write_exr(path, np.ascontiguousarray(pixels))
    except InputError as error:
        desk.say(str(error), "error")
    else:
        desk.say(f"wrote {path}")
