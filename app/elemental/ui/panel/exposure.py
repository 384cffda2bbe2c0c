"""The histogram of the picture with the adapted value drawn over it.

[Mittring12 "Histogram", "Eye Adaptation (Auto-Exposure)"]
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from imgui_bundle import imgui

from elemental.ui import theme
from elemental.ui.observers import EyeReading
from elemental.ui.theme import Rgb
from elemental.ui.widgets import Widgets

LEAST_HEIGHT_PX = 60.0
TICK_EV = 2
"""Stops between two numbers of the axis, or a multiple where there is little room."""


def exposure_page(w: Widgets, eye: EyeReading | None, settings: Mapping[str, Any]) -> None:
    """Draw the page. ``settings``: the frame's, the volumes' overrides among them."""
    if eye is None:
        w.hint("No histogram yet.")
        return
    low, high = settings["eye_adaptation.min_brightness"], settings["eye_adaptation.max_brightness"]
    w.facts(
        "figures",
        [
            ("measured", f"{eye.measured:.4f} nit", theme.BLUE),
            ("adapted to", f"{eye.brightness:.4f} nit", theme.ACCENT),
            ("that is", f"{math.log2(max(eye.brightness, 1e-9)):+.2f} EV"),
            ("bounds", f"{low:g} to {high:g} nit"),
            ("bias", f"{settings['exposure']:+.2f} EV"),
        ],
    )
    if not eye.histogram.any():
        w.hint("Adaptation is off: the least and the greatest brightness are equal.")
    room = imgui.get_content_region_avail()
    axis = imgui.get_text_line_height()
    size = imgui.ImVec2(max(room.x, 1.0), max(room.y - axis - 4.0, LEAST_HEIGHT_PX))
    corner = imgui.get_cursor_screen_pos()
    imgui.invisible_button("histogram", size)
    w.note("histogram")
    log_min = settings["eye_adaptation.log_min"]
    span = max(settings["eye_adaptation.log_max"] - log_min, 1.0)
    _bars(eye, corner, size, log_min, span)
    _percentiles(eye, settings, corner, size)
    for brightness, rgb, name in (
        (low, theme.MUTED, "min"), (high, theme.MUTED, "max"),
        (eye.measured, theme.BLUE, "measured"), (eye.brightness, theme.ACCENT, "adapted"),
    ):  # fmt: skip
        share = (math.log2(max(brightness, 1e-9)) - log_min) / span
        _line(corner, size, share, rgb, name)
    _axis(corner, size, log_min, span)
    imgui.dummy(imgui.ImVec2(1.0, axis))


def _bars(
    eye: EyeReading, corner: imgui.ImVec2, size: imgui.ImVec2, log_min: float, span: float
) -> None:
    canvas = imgui.get_window_draw_list()
    end = imgui.ImVec2(corner.x + size.x, corner.y + size.y)
    canvas.add_rect_filled(corner, end, theme.packed(theme.BACKDROP), 3.0)
    shares = eye.histogram
    top = max(float(shares.max()), 1e-6)
    width = size.x / len(shares)
    for bucket, share in enumerate(shares):
        height = 0.92 * size.y * float(share) / top
        left = corner.x + bucket * width
        canvas.add_rect_filled(
            imgui.ImVec2(left + 0.5, end.y - height),
            imgui.ImVec2(left + width - 0.5, end.y),
            theme.packed((0.50, 0.53, 0.56), 0.9),
        )
    if imgui.is_item_hovered():
        bucket = int((imgui.get_mouse_pos().x - corner.x) / width)
        if 0 <= bucket < len(shares):
            ev = log_min + span * (bucket + 0.5) / len(shares)
            imgui.set_tooltip(f"{ev:+.2f} EV, {2**ev:.4g}: {100 * shares[bucket]:.2f} %")


def _percentiles(
    eye: EyeReading, settings: Mapping[str, Any], corner: imgui.ImVec2, size: imgui.ImVec2
) -> None:
    """What counts: between the low and the high percentile."""
    total = np.cumsum(eye.histogram)
    if total[-1] <= 0.0:
        return
    canvas = imgui.get_window_draw_list()
    keys = ("eye_adaptation.low_percent", "eye_adaptation.high_percent")
    low, high = (
        float(np.searchsorted(total, settings[key] / 100.0 * total[-1])) / len(total)
        for key in keys
    )
    canvas.add_rect_filled(
        imgui.ImVec2(corner.x + low * size.x, corner.y),
        imgui.ImVec2(corner.x + min(high + 1 / len(total), 1.0) * size.x, corner.y + size.y),
        theme.packed(theme.BLUE, 0.14),
    )


def _line(corner: imgui.ImVec2, size: imgui.ImVec2, share: float, rgb: Rgb, name: str) -> None:
    if not 0.0 <= share <= 1.0:
        return
    canvas = imgui.get_window_draw_list()
    x = corner.x + share * size.x
    bright = name == "adapted"
    canvas.add_line(
        imgui.ImVec2(x, corner.y),
        imgui.ImVec2(x, corner.y + size.y),
        theme.packed(rgb, 1.0 if bright else 0.7),
        2.0 if bright else 1.0,
    )
    row = ("adapted", "measured", "min", "max").index(name)
    line = imgui.get_text_line_height()
    if (row + 1) * line + 3.0 > size.y:
        return
    place = imgui.ImVec2(x + 4.0, corner.y + 3.0 + row * line)
    if x + imgui.calc_text_size(name).x + 6.0 > corner.x + size.x:
        place.x = x - imgui.calc_text_size(name).x - 4.0
    canvas.add_text(place, theme.packed(rgb), name)


def _axis(corner: imgui.ImVec2, size: imgui.ImVec2, log_min: float, span: float) -> None:
    canvas = imgui.get_window_draw_list()
    widest = imgui.calc_text_size("+16 EV").x
    step = TICK_EV * max(math.ceil(widest / max(size.x * TICK_EV / span, 1.0)), 1)
    for ev in range(math.ceil(log_min / step) * step, int(log_min + span) + 1, step):
        x = corner.x + size.x * (ev - log_min) / span
        text = f"{ev:+d}" if ev else "0 EV"
        half = imgui.calc_text_size(text).x / 2
        left = min(max(x - half, corner.x), corner.x + size.x - 2 * half)
        canvas.add_text(
            imgui.ImVec2(left, corner.y + size.y + 3.0), theme.packed(theme.MUTED), text
        )
