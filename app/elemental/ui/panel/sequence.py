"""Screenshots and frame sequences: what to render, where to, and how far it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from imgui_bundle import imgui

from elemental.settings import Setting
from elemental.ui import icons, theme
from elemental.ui.rows import property_row
from elemental.ui.sequence_job import SequenceJob, SequenceWords
from elemental.ui.widgets import Widgets

DEFAULT = SequenceWords(Path("frames"))
START_EM = 11.0
"""Width of the button that starts, in heights of the text."""
FRAME = Setting("frame", "int", 0, "number of a frame; frame n is at n / fps seconds", lo=0)
FPS = Setting("fps", "float", 30.0, "frames a second of scene time", lo=1.0, hi=120.0)
SIDE = Setting("side", "int", 1280, "of the pictures", unit="px", lo=1, hi=16384)


def sequence_page(
    w: Widgets,
    words: SequenceWords,
    job: SequenceJob | None,
    act: Callable[[str], None],
) -> SequenceWords:
    """Draw the page; "sequence.start", "sequence.stop" and "screenshot" are asked of ``act``."""
    _buttons(w, job, act)
    if job is not None:
        text = f"{job.done} of {job.count}   {job.newest}{left_text(job)}"
        imgui.progress_bar(job.done / max(job.count, 1), imgui.ImVec2(-1.0, 0.0), text)
        w.note("progress")
        if not job.is_over:
            return words
    return _words(w, words)


def left_text(job: SequenceJob) -> str:
    """How long a running sequence still takes, where that can be told."""
    if job.is_over or job.seconds_left is None:
        return ""
    minutes, seconds = divmod(round(job.seconds_left), 60)
    return f"   {minutes}:{seconds:02d} left"


def _buttons(w: Widgets, job: SequenceJob | None, act: Callable[[str], None]) -> None:
    if w.button(f"{icons.SHOT}  Screenshot", "screenshot", help="the picture, without the panel"):
        act("screenshot")
    w.flow(START_EM * imgui.get_font_size())
    if job is not None and not job.is_over:
        if w.button(f"{icons.STOP}  Stop", "stop", help="what is there is kept"):
            act("sequence.stop")
    elif w.button(f"{icons.FILM}  Render the sequence", "start", help="goes on where it stopped"):
        act("sequence.start")


def _words(w: Widgets, words: SequenceWords) -> SequenceWords:
    w.row("Folder", "made if it is missing; frames that are there are kept")
    edit = w.typed("folder", str(words.folder))
    if edit is not None and edit.value:
        words = replace(words, folder=Path(edit.value).expanduser())
    w.row("Name", "with %05d for the frame's number; .png, or .exr for linear light")
    edit = w.typed("name", words.name)
    if edit is not None and edit.value:
        words = replace(words, name=Path(edit.value).name)
    first, last = words.frames
    for label, value, default in (("first", first, 0), ("last", last, DEFAULT.frames[1])):
        edit = property_row(w, label, f"{label.capitalize()} frame", FRAME, value, default)
        if edit is not None:
            frames = (edit.value, last) if label == "first" else (first, edit.value)
            words = replace(words, frames=frames)
    edit = property_row(w, "fps", "Frames a second", FPS, words.fps, DEFAULT.fps)
    if edit is not None:
        words = replace(words, fps=edit.value)
    width, height = words.size
    for label, value, default in (("width", width, 1280), ("height", height, 720)):
        edit = property_row(w, label, label.capitalize(), SIDE, value, default)
        if edit is not None:
            size = (edit.value, height) if label == "width" else (width, edit.value)
            words = replace(words, size=size)
    w.row("Overwrite", "begin anew where frames of something else are", small=True)
    words = replace(words, overwrite=w.tick("", words.overwrite, "overwrite"))
    w.text(f"{(last - first + 1) / words.fps:.2f} s", theme.MUTED)
    return words
