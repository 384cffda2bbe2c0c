"""Where the frame's time goes: a strip of passes to scale, and a row for each of them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt
from imgui_bundle import imgui

from elemental.ui import theme
from elemental.ui.measured import Times
from elemental.ui.theme import Rgb
from elemental.ui.widgets import Widgets

HUES: tuple[Rgb, ...] = (
    (0.42, 0.58, 0.78), (0.80, 0.55, 0.32), (0.48, 0.68, 0.46), (0.70, 0.46, 0.58),
    (0.72, 0.68, 0.40), (0.40, 0.66, 0.66), (0.60, 0.52, 0.74), (0.74, 0.44, 0.38),
)  # fmt: skip
"""Of systems, in the order in which they come up."""
STRIP_EM = 1.6
HISTORY_EM = 2.8
"""Heights, in those of the text."""
LEAST_ROWS = 6
BAR_SHARE = 0.42
"""Of a row's width, for its bar."""
NAME_EM = 12.0
"""Least room for a pass's name, in heights of the text: where bars leave less, they go."""
UNKNOWN = "–"


def ms_text(ms: float | None) -> str:
    """A time in three digits or more, or a dash where there is none yet."""
    if ms is None:
        return UNKNOWN
    places = 2 if ms < 10.0 else 1 if ms < 100.0 else 0
    return f"{ms:,.{places}f} ms"


def system_of(name: str) -> str:
    """The system that a pass belongs to, by its name: ``bloom.along0`` and ``bloom/x`` to bloom."""
    return re.split(r"[./ ]", name, maxsplit=1)[0]


def hues_of(names: Sequence[str]) -> dict[str, Rgb]:
    """A colour for each system."""
    systems = dict.fromkeys(map(system_of, names))
    return {system: HUES[k % len(HUES)] for k, system in enumerate(systems)}


def timeline_page(w: Widgets, times: Times) -> None:
    """Draw the page."""
    gpu_ms, cpu_ms, history = times.gpu, times.cpu, times.history
    total = sum(gpu_ms.values())
    w.facts(
        "figures",
        [
            ("frame", ms_text(times.frame)),
            ("frames/s", f"{1e3 / times.frame:.1f}" if times.frame else UNKNOWN),
            ("GPU", ms_text(total if gpu_ms else None)),
            ("CPU", ms_text(sum(cpu_ms.values()) if cpu_ms else None)),
            ("panel", ms_text(times.panel)),
        ],
    )
    if not gpu_ms:
        w.hint("Times are known once a frame is done.")
        return
    if len(history) > 1:
        _history(w, history)
    hues = hues_of(list(gpu_ms))
    _strip(w, gpu_ms, total, hues)
    _rows(w, gpu_ms, cpu_ms, hues)


def _history(w: Widgets, history: npt.NDArray[np.float32]) -> None:
    """The last frames' times from 0 to the number at the top."""
    corner, em = imgui.get_cursor_screen_pos(), imgui.get_font_size()
    top = max(float(np.percentile(history, 95)) * 1.25, 1.0)
    size = imgui.ImVec2(-1.0, HISTORY_EM * em)
    imgui.plot_lines("##history", history, 0, "", 0.0, top, size)
    w.note("history")
    w.tooltip(f"{len(history)} frames, the newest at the right; 0 to {top:.0f} ms")
    told, canvas = f"{top:,.0f} ms", imgui.get_window_draw_list()
    place = imgui.ImVec2(corner.x + 0.4 * em, corner.y + 0.15 * em)
    size = imgui.calc_text_size(told)
    end = imgui.ImVec2(place.x + size.x, place.y + size.y)
    canvas.add_rect_filled(place, end, theme.packed(theme.BACKDROP, 0.8), 2.0)
    canvas.add_text(place, theme.packed(theme.MUTED), told)


def _strip(w: Widgets, gpu_ms: Mapping[str, float], total: float, hues: Mapping[str, Rgb]) -> None:
    """All passes side by side, to scale; the one under the mouse is named."""
    corner = imgui.get_cursor_screen_pos()
    width = imgui.get_content_region_avail().x
    height = STRIP_EM * imgui.get_font_size()
    imgui.invisible_button("strip", imgui.ImVec2(max(width, 1.0), height))
    w.note("strip")
    mouse = imgui.get_mouse_pos().x if imgui.is_item_hovered() else -1.0
    canvas = imgui.get_window_draw_list()
    x = corner.x
    for name, ms in gpu_ms.items():
        end = x + width * ms / total if total > 0 else x
        lit = x <= mouse < end
        hue = theme.packed(hues[system_of(name)], 1.0 if lit else 0.8)
        inner = max(end - 1.0, x + 0.5)
        canvas.add_rect_filled(
            imgui.ImVec2(x, corner.y), imgui.ImVec2(inner, corner.y + height), hue
        )
        if lit:
            imgui.set_tooltip(f"{name}  {ms:.3f} ms  {100 * ms / total:.1f} %")
        x = end


def _rows(
    w: Widgets,
    gpu_ms: Mapping[str, float],
    cpu_ms: Mapping[str, float],
    hues: Mapping[str, Rgb],
) -> None:
    least = LEAST_ROWS * imgui.get_text_line_height_with_spacing()
    height = max(imgui.get_content_region_avail().y, least)
    if not imgui.begin_child("passes", imgui.ImVec2(0.0, height)):
        imgui.end_child()
        return
    names = list(gpu_ms)
    longest = max(gpu_ms.values(), default=0.0) or 1.0
    clipper = imgui.ListClipper()
    clipper.begin(len(names))
    canvas = imgui.get_window_draw_list()
    width, em = imgui.get_content_region_avail().x, imgui.get_font_size()
    with w.figures():
        digit = imgui.calc_text_size("0").x
    has_cpu = NAME_EM * em + 20 * digit <= width
    digits = (20 if has_cpu else 10) * digit
    bars = BAR_SHARE * width if (1.0 - BAR_SHARE) * width >= NAME_EM * em + digits else 0.0
    name_width = width - bars - digits - em
    while clipper.step():
        for name in names[clipper.display_start : clipper.display_end]:
            corner = imgui.get_cursor_screen_pos()
            height = imgui.get_text_line_height()
            left = corner.x + width - bars
            if bars:
                end = left + max(bars * gpu_ms[name] / longest, 1.0)
                canvas.add_rect_filled(
                    imgui.ImVec2(left, corner.y + 3.0),
                    imgui.ImVec2(end, corner.y + height - 3.0),
                    theme.packed(hues[system_of(name)], 0.85),
                )
            w.cut(name, name_width)
            w.note(name)
            imgui.same_line(width - bars - digits - 0.5 * em)
            with w.figures():
                cpu = f" {cpu_ms.get(name, 0.0):9.3f}" if has_cpu else ""
                w.text(f"{gpu_ms[name]:9.3f}{cpu}", theme.MUTED)
            w.tooltip(f"GPU {gpu_ms[name]:.3f} ms, CPU {cpu_ms.get(name, 0.0):.3f} ms")
    clipper.end()
    imgui.end_child()
