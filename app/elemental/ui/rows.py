"""Rows of a label, a value and a reset, for any value that a ``Setting`` describes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from imgui_bundle import imgui

from elemental.settings import Setting
from elemental.ui.widgets import Edit, Widgets


def is_out_of_sight() -> bool:
    """Whether the row that begins here can't be seen; room is left for it then."""
    height = imgui.get_frame_height()
    if imgui.is_rect_visible(imgui.ImVec2(1.0, height)):
        return False
    imgui.dummy(imgui.ImVec2(1.0, height))
    return True


def property_row(
    w: Widgets, name: str, label: str, setting: Setting, value: Any, default: Any
) -> Edit | None:
    """A row for one value; returns the edit made in this frame."""
    if is_out_of_sight():
        return None
    changed = value != default
    imgui.push_id(name)
    w.row(label, help_text(setting), changed)
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
    """A row for a place, a direction or a size."""
    if is_out_of_sight():
        return None
    changed = tuple(value) != tuple(default)
    imgui.push_id(name)
    w.row(label, help, changed)
    edit = w.vector(name, value, unit, lo, hi)
    if w.reset(name, changed, ", ".join(f"{part:g}" for part in default)):
        edit = Edit(tuple(default))
    imgui.pop_id()
    return edit


def help_text(setting: Setting) -> str:
    """What a tooltip tells of a setting: meaning, range, default, key and source."""
    lines = [setting.help, f"{setting.range_text()}; default {setting.value_text(setting.default)}"]
    return "\n".join([*lines, " ".join(part for part in (setting.key, setting.source) if part)])
