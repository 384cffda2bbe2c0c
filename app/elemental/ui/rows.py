"""Rows of a label, a value and a reset, for any value that a ``Setting`` describes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from imgui_bundle import imgui

from elemental.settings import Setting
from elemental.ui.widgets import Edit, Widgets

ABBREVIATIONS = {"color": "colour", "ior": "IOR", "lut": "LUT", "fps": "frames a second"}
"""Words of names that a label has otherwise."""


LIST_ROWS = 6
LIST_SHARE = 0.3
"""Of a page's height, for the list above what is chosen in it."""


def list_height(count: int) -> float:
    """Of a list above what is chosen in it, px: a few of its rows, fewer on a low page."""
    row = imgui.get_text_line_height_with_spacing()
    room = LIST_SHARE * imgui.get_content_region_avail().y
    return max(min(min(count, LIST_ROWS) * row, room), 1.5 * row) + 4.0


def spelled(name: str) -> str:
    """A name as a label: ``base_color`` is Base colour."""
    words = " ".join(ABBREVIATIONS.get(word, word) for word in name.split("_"))
    return words[0].upper() + words[1:]


def property_row(
    w: Widgets, name: str, label: str, setting: Setting, value: Any, default: Any
) -> Edit | None:
    """A row for one value; returns the edit made in this frame."""
    small = setting.kind == "bool"
    if w.is_out_of_sight(label, small):
        return None
    changed = value != default
    imgui.push_id(name)
    w.row(label, help_text(setting), changed, small)
    edit = w.value(name, setting, value)
    if w.reset(name, changed, setting.value_text(default) or "nothing"):
        edit = Edit(default)
    imgui.pop_id()
    return edit


def vector_row(
    w: Widgets,
    name: str,
    label: str,
    value: Sequence[float],
    default: Sequence[float],
    *,
    unit: str = "",
    help: str = "",
    lo: float | None = None,
    hi: float | None = None,
) -> Edit | None:
    """A row for a place, a direction or a size; the unit stands behind the label."""
    label = f"{label} ({unit})" if unit else label
    if w.is_out_of_sight(label):
        return None
    changed = tuple(value) != tuple(default)
    imgui.push_id(name)
    w.row(label, help, changed)
    edit = w.vector(name, value, lo, hi)
    if w.reset(name, changed, ", ".join(f"{part:g}" for part in default)):
        edit = Edit(tuple(default))
    imgui.pop_id()
    return edit


def help_text(setting: Setting) -> str:
    """What a tooltip tells of a setting: meaning, range, default, key and source."""
    lines = [setting.help, f"{setting.range_text()}; default {setting.value_text(setting.default)}"]
    return "\n".join([*lines, " ".join(part for part in (setting.key, setting.source) if part)])
