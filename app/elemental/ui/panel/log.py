"""What happened: notes, warnings, errors, the newest at the end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from imgui_bundle import imgui

from elemental.ui import theme
from elemental.ui.log import LONGEST, Entry, Kind, Log
from elemental.ui.widgets import Widgets

LEAST_SEARCH_EM = 7.0
COLORS = {"note": theme.TEXT, "warning": theme.ACCENT, "error": theme.RED}


@dataclass
class LogFilter:
    """Which kinds show, and which text they hold."""

    kinds: set[Kind] = field(default_factory=lambda: {"note", "warning", "error"})
    text: str = ""


def log_page(w: Widgets, log: Log, shown: LogFilter) -> None:
    """Draw the page."""
    kinds: tuple[Kind, ...] = ("note", "warning", "error")
    em = imgui.get_font_size()
    for number, kind in enumerate(kinds):
        label = f"{kind}s {log.count(kind)}"
        if number:
            w.flow(imgui.calc_text_size(label).x + 2.0 * em)
        ticked = w.tick(label, kind in shown.kinds, kind)
        (shown.kinds.add if ticked else shown.kinds.discard)(kind)
    w.flow(3.5 * em)
    if w.button("Copy", help="everything that shows, to the clipboard"):
        imgui.set_clipboard_text("\n".join(entry.text for entry in _matching(log, shown)))
    w.flow(3.5 * em)
    if w.button("Clear"):
        log.entries.clear()
    w.flow(LEAST_SEARCH_EM * em)
    shown.text = w.search("search", shown.text)
    if imgui.begin_child("lines"):
        _lines(w, _matching(log, shown))
        if imgui.get_scroll_y() >= imgui.get_scroll_max_y():
            imgui.set_scroll_here_y(1.0)
    imgui.end_child()


def _lines(w: Widgets, entries: Sequence[Entry]) -> None:
    """Wrapped lines; those out of sight only leave their room."""
    with w.figures():
        indent = imgui.calc_text_size("0000.00 ").x
    width = imgui.get_content_region_avail().x - indent
    spacing = imgui.get_style().item_spacing.y
    em = imgui.get_font_size()
    unseen = 0.0
    for entry in entries:
        times = f"  ×{entry.count}" if entry.count > 1 else ""
        text = " ".join(entry.text.split()) + times
        height = _height(text, round(width), em)
        at = imgui.ImVec2(1.0, unseen + height)
        if not imgui.is_rect_visible(at):
            unseen += height + spacing
            continue
        if unseen:
            imgui.dummy(imgui.ImVec2(1.0, unseen - spacing))
            unseen = 0.0
        with w.figures():
            w.text(f"{entry.time_s:7.2f}", theme.MUTED)
        imgui.same_line(indent)
        w.paragraph(text, COLORS[entry.kind])
        w.note(entry.text)
    if unseen:
        imgui.dummy(imgui.ImVec2(1.0, unseen - spacing))


@lru_cache(maxsize=2 * LONGEST)
def _height(text: str, width: int, _em: float) -> float:
    """Of a wrapped line, px."""
    return float(imgui.calc_text_size(text, False, width).y)


def _matching(log: Log, shown: LogFilter) -> list[Entry]:
    word = shown.text.lower()
    return [e for e in log.entries if e.kind in shown.kinds and word in e.text.lower()]
