"""What happened: notes, warnings, errors, the newest at the end."""

from __future__ import annotations

from dataclasses import dataclass, field

from imgui_bundle import imgui

from elemental.ui import theme
from elemental.ui.log import Entry, Kind, Log
from elemental.ui.widgets import Widgets

COLORS = {"note": theme.TEXT, "warning": theme.ACCENT, "error": theme.RED}


@dataclass
class LogFilter:
    """Which kinds show, and which text they hold."""

    kinds: set[Kind] = field(default_factory=lambda: {"note", "warning", "error"})
    text: str = ""


def log_page(w: Widgets, log: Log, shown: LogFilter) -> None:
    """Draw the page."""
    kinds: tuple[Kind, ...] = ("note", "warning", "error")
    for kind in kinds:
        ticked = w.tick(f"{kind}s {log.count(kind)}", kind in shown.kinds, kind)
        (shown.kinds.add if ticked else shown.kinds.discard)(kind)
        imgui.same_line()
    if w.button("Copy", help="everything that shows, to the clipboard"):
        imgui.set_clipboard_text("\n".join(entry.text for entry in _matching(log, shown)))
    imgui.same_line()
    if w.button("Clear"):
        log.entries.clear()
    imgui.same_line()
    shown.text = w.search("search", shown.text)
    if imgui.begin_child("lines"):
        entries = _matching(log, shown)
        clipper = imgui.ListClipper()
        clipper.begin(len(entries))
        while clipper.step():
            for entry in entries[clipper.display_start : clipper.display_end]:
                with w.figures():
                    w.text(f"{entry.time_s:8.2f}", theme.MUTED)
                imgui.same_line()
                times = f"  ×{entry.count}" if entry.count > 1 else ""
                w.text(" ".join(entry.text.split()) + times, COLORS[entry.kind])
                w.note(entry.text)
        clipper.end()
        if imgui.get_scroll_y() >= imgui.get_scroll_max_y():
            imgui.set_scroll_here_y(1.0)
    imgui.end_child()


def _matching(log: Log, shown: LogFilter) -> list[Entry]:
    word = shown.text.lower()
    return [e for e in log.entries if e.kind in shown.kinds and word in e.text.lower()]
