"""Where the frame's time goes: a strip of passes to scale, and a row for each of them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt
from imgui_bundle import imgui

from elemental.ui import theme
from elemental.ui.theme import Rgb
from elemental.ui.widgets import Widgets

HUES: tuple[Rgb, ...] = (
    (0.42, 0.58, 0.78), (0.80, 0.55, 0.32), (0.48, 0.68, 0.46), (0.70, 0.46, 0.58),
    (0.72, 0.68, 0.40), (0.40, 0.66, 0.66), (0.60, 0.52, 0.74), (0.74, 0.44, 0.38),
)  # fmt: skip
"""Of systems, in the order in which they come up."""
STRIP_PX = 26.0
HISTORY_PX = 44.0
BAR_SHARE = 0.42
"""Of a row's width, for its bar."""


def system_of(name: str) -> str:
    """The system that a pass belongs to, by its name: ``bloom.along0`` and ``bloom/x`` to bloom."""
    return re.split(r"[./ ]", name, maxsplit=1)[0]


def hues_of(names: Sequence[str]) -> dict[str, Rgb]:
    """A colour for each system."""
    systems = dict.fromkeys(map(system_of, names))
    return {system: HUES[k % len(HUES)] for k, system in enumerate(systems)}


def timeline_page(
    w: Widgets,
    gpu_ms: Mapping[str, float],
    cpu_ms: Mapping[str, float],
    frame_ms: float,
    panel_ms: float,
    history: npt.NDArray[np.float32],
) -> None:
    """Averaged times by pass in the order of the frame; ``history``: frame times, oldest first."""
    total = sum(gpu_ms.values())
    with w.figures():
        rate = 1e3 / frame_ms if frame_ms > 0 else 0.0
        w.text(
            f"frame {frame_ms:7.2f} ms  {rate:5.1f}/s    GPU {total:7.2f} ms    "
            f"CPU {sum(cpu_ms.values()):6.2f} ms    panel {panel_ms:5.2f} ms"
        )
    w.note("figures")
    if len(history) > 1:
        size = imgui.ImVec2(-1.0, HISTORY_PX)
        top = max(float(np.percentile(history, 95)) * 1.25, 1.0)
        imgui.plot_lines("##history", history, 0, f"{top:.0f} ms", 0.0, top, size)
        w.note("history")
    hues = hues_of(list(gpu_ms))
    _strip(w, gpu_ms, total, hues)
    _rows(w, gpu_ms, cpu_ms, hues)


def _strip(w: Widgets, gpu_ms: Mapping[str, float], total: float, hues: Mapping[str, Rgb]) -> None:
    """All passes side by side, to scale; the one under the mouse is named."""
    corner = imgui.get_cursor_screen_pos()
    width = imgui.get_content_region_avail().x
    imgui.invisible_button("strip", imgui.ImVec2(max(width, 1.0), STRIP_PX))
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
            imgui.ImVec2(x, corner.y), imgui.ImVec2(inner, corner.y + STRIP_PX), hue
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
    if not imgui.begin_child("passes"):
        imgui.end_child()
        return
    names = list(gpu_ms)
    longest = max(gpu_ms.values(), default=0.0) or 1.0
    clipper = imgui.ListClipper()
    clipper.begin(len(names))
    canvas = imgui.get_window_draw_list()
    while clipper.step():
        for name in names[clipper.display_start : clipper.display_end]:
            width = imgui.get_content_region_avail().x
            corner = imgui.get_cursor_screen_pos()
            height = imgui.get_text_line_height()
            left = corner.x + (1.0 - BAR_SHARE) * width
            end = left + max(BAR_SHARE * width * gpu_ms[name] / longest, 1.0)
            canvas.add_rect_filled(
                imgui.ImVec2(left, corner.y + 3.0),
                imgui.ImVec2(end, corner.y + height - 3.0),
                theme.packed(hues[system_of(name)], 0.85),
            )
            w.text(name)
            w.note(name)
            with w.figures():
                figures = f"{gpu_ms[name]:8.3f}  {cpu_ms.get(name, 0.0):7.3f}"
                place = (1.0 - BAR_SHARE) * width - imgui.calc_text_size(figures).x - 8.0
                imgui.same_line(max(place, 0.0))
                w.text(figures, theme.MUTED)
    clipper.end()
    imgui.end_child()
