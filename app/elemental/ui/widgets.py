"""The few kinds of widgets that every page is made of: rows of a label, a value and a reset.

Each widget's rectangle can be recorded by page and label, so that tests find it as an artist
does: by what it says.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from imgui_bundle import imgui

from elemental.core.srgb import decode_srgb, encode_srgb
from elemental.settings import Setting
from elemental.ui import icons
from elemental.ui.lines import Lines
from elemental.ui.theme import Fonts

LOGARITHMIC_SPAN = 100.0
"""A range that is wider than this is slid over by factors, not by differences."""
LARGEST_SPAN = 2e5
"""A range that is wider than this is none to slide over."""
FARTHEST = 1e9
"""Bound of what can be dragged where there is no other."""
DRAG_SPEED = 0.005
"""Change by a pixel, as a part of the value."""


class Edit(NamedTuple):
    """A new value, and the gesture that it belongs to: None where it is a step of its own."""

    value: Any
    gesture: Hashable = None


class Browsing(NamedTuple):
    """A row that asks for a file: its page and name, its setting and value."""

    key: str
    setting: Setting
    value: str
    folder: Path | None
    """From which the value counts; None: that of the settings' names."""


class Widgets(Lines):
    """ImGui's widgets in the panel's manner."""

    def __init__(self, fonts: Fonts, records: bool = False) -> None:
        super().__init__(fonts, records)
        self.browsing: Browsing | None = None
        """A row that asks for a file."""
        self.browsed: dict[str, str] = {}
        """Files that were chosen for rows, until these take them."""
        self._typed: dict[int, str] = {}

    def button(self, label: str, name: str = "", enabled: bool = True, help: str = "") -> bool:
        """A button; ``name`` is what it is recorded as where the label is an icon."""
        imgui.begin_disabled(not enabled)
        pressed = imgui.button(f"{label}###{name or label}")
        self.note(name or label)
        imgui.end_disabled()
        self.tooltip(help)
        return pressed

    def tick(self, label: str, value: bool, name: str = "") -> bool:
        """A box to tick, with its label behind it; returns whether it is ticked now."""
        _, ticked = imgui.checkbox(f"{label}###{name or label}", value)
        self.note(name or label)
        return bool(ticked)

    def choose(self, name: str, value: str, choices: Sequence[str], width: float = 0.0) -> str:
        """A drop-down list; returns what is chosen now."""
        imgui.set_next_item_width(width or imgui.calc_item_width())
        chosen = value
        is_open = imgui.begin_combo(f"##{name}", value, imgui.ComboFlags_.height_large.value)
        self.note(name)
        if is_open:
            for choice in choices:
                if imgui.selectable(choice, choice == value)[0]:
                    chosen = choice
                self.note(f"{name}={choice}")
                if choice == value:
                    imgui.set_item_default_focus()
            imgui.end_combo()
        return chosen

    def search(self, name: str, text: str) -> str:
        """A field to search by; returns its text."""
        imgui.set_next_item_width(-1.0)
        _, text = imgui.input_text_with_hint(f"##{name}", f"{icons.SEARCH}  search", text)
        self.note(name)
        return str(text)

    def section(self, title: str, is_open: bool = True) -> bool:
        """A heading that folds; returns whether what is under it shows."""
        flags = imgui.TreeNodeFlags_.default_open.value if is_open else 0
        shows = bool(imgui.collapsing_header(title, flags))
        self.note(title.partition("###")[2] or title)
        return shows

    # Values -------------------------------------------------------------------------------------

    def value(self, name: str, setting: Setting, value: Any) -> Edit | None:
        """The widget of a value by its kind, of the next item's width."""
        if setting.kind == "bool":
            ticked = self.tick("", value, name)
            return Edit(ticked) if ticked != value else None
        if setting.kind == "choice":
            texts = [str(choice) for choice in setting.choices]
            chosen = self.choose(name, str(value), texts)
            return Edit(setting.choices[texts.index(chosen)]) if chosen != str(value) else None
        if setting.kind == "color":
            return self.color(name, value, setting.hi)
        if setting.kind == "text":
            return (
                self.file(name, setting, value)
                if setting.unit == "file"
                else (self.typed(name, value))
            )
        return self.number(name, setting, value)

    def number(self, name: str, setting: Setting, value: float) -> Edit | None:
        """A slider over the setting's range; Ctrl and a click, or a double click, to type."""
        if setting.lo is None or setting.hi is None or setting.hi - setting.lo > LARGEST_SPAN:
            return self.drag(name, setting, value)
        lo, hi = setting.lo, setting.hi
        wide = hi - lo > LOGARITHMIC_SPAN
        flags = imgui.SliderFlags_.always_clamp.value
        flags |= imgui.SliderFlags_.logarithmic.value if wide else 0
        unit = _unit(setting)
        changed: bool
        number: float
        if setting.kind == "int":
            places = f"%d{unit}"
            changed, number = imgui.slider_int(
                f"##{name}", int(value), int(lo), int(hi), places, flags
            )
        else:
            places = ("%.4g" if wide else f"%.{3 if hi - lo <= 2.0 else 2}f") + unit
            changed, number = imgui.slider_float(f"##{name}", float(value), lo, hi, places, flags)
        self.note(name)
        short = _short(number, setting.kind, lo, hi)
        return Edit(short, imgui.get_item_id()) if changed else None

    def drag(self, name: str, setting: Setting, value: float) -> Edit | None:
        """A number without bounds to slide between: a drag changes it by a hundredth of itself."""
        lo = -FARTHEST if setting.lo is None else setting.lo
        hi = FARTHEST if setting.hi is None else setting.hi
        clamp = imgui.SliderFlags_.always_clamp.value
        changed: bool
        number: float
        if setting.kind == "int":
            changed, number = imgui.drag_int(
                f"##{name}", int(value), 0.1, int(lo), int(hi), f"%d{_unit(setting)}", clamp
            )
        else:
            speed = max(abs(value), 1.0) * DRAG_SPEED
            changed, number = imgui.drag_float(
                f"##{name}", float(value), speed, lo, hi, f"%.4g{_unit(setting)}", clamp
            )
        self.note(name)
        short = _short(number, setting.kind, lo, hi)
        return Edit(short, imgui.get_item_id()) if changed else None

    def vector(
        self,
        name: str,
        value: Sequence[float],
        lo: float | None = None,
        hi: float | None = None,
    ) -> Edit | None:
        """Two or three numbers to drag or type."""
        speed = max(*(abs(part) for part in value), 1.0) * DRAG_SPEED
        low, high = -FARTHEST if lo is None else lo, FARTHEST if hi is None else hi
        clamp = imgui.SliderFlags_.always_clamp.value
        drag = imgui.drag_float3 if len(value) == 3 else imgui.drag_float2
        changed, dragged = drag(f"##{name}", list(value), speed, low, high, "%.4g", clamp)
        self.note(name)
        return (
            Edit(tuple(_short(part, "float", low, high) for part in dragged), imgui.get_item_id())
            if changed
            else None
        )

    def color(self, name: str, value: Sequence[float], hi: float | None = 1.0) -> Edit | None:
        """Three linear components to drag or type, and a swatch that opens a picker."""
        edit = None
        side = imgui.get_frame_height()
        spacing = imgui.get_style().item_inner_spacing.x
        imgui.set_next_item_width(imgui.calc_item_width() - side - spacing)
        clamp = imgui.SliderFlags_.always_clamp.value
        top = hi if hi is not None else FARTHEST
        digits = "%.3f" if max(*value, 0.0) < 10.0 else "%.4g"
        changed, dragged = imgui.drag_float3(
            f"##{name}", list(value), 0.005, 0.0, top, digits, clamp
        )
        self.note(name)
        if changed:
            edit = Edit(tuple(_short(c, "float", 0.0, top) for c in dragged), imgui.get_item_id())
        imgui.same_line(0.0, spacing)
        shown = encode_srgb(np.asarray(value, np.float32))
        red, green, blue = (min(float(c), 1.0) for c in shown)
        swatch = imgui.ImVec4(red, green, blue, 1.0)
        size = imgui.ImVec2(side, side)
        if imgui.color_button(f"swatch {name}", swatch, imgui.ColorEditFlags_.no_tooltip, size):
            imgui.open_popup("picker")
        self.note(f"swatch {name}")
        if imgui.begin_popup("picker"):
            flags = imgui.ColorEditFlags_.no_side_preview | imgui.ColorEditFlags_.hdr
            picked, codes = imgui.color_picker3(
                f"##picker {name}", [float(c) for c in shown], flags
            )
            self.note(f"picker {name}")
            if picked:
                linear = decode_srgb(np.clip(np.asarray(codes, np.float32), 0.0, None))
                clipped = np.minimum(linear, top)
                edit = Edit(
                    tuple(_short(c, "float", 0.0, top) for c in clipped), imgui.get_item_id()
                )
            imgui.end_popup()
        return edit

    def file(
        self, name: str, setting: Setting, value: str, hint: str = "", folder: Path | None = None
    ) -> Edit | None:
        """A file's name to type, and a button to look for it; names count from ``folder``."""
        spacing = imgui.get_style().item_inner_spacing.x
        button = imgui.get_font_size() + 2.0 * imgui.get_style().frame_padding.x
        imgui.set_next_item_width(imgui.calc_item_width() - button - spacing)
        edit = self.typed(name, value, hint)
        imgui.same_line(0.0, spacing)
        key = f"{self.page}/{name}"
        if self.button(icons.FOLDER, f"browse {name}", help="look for a file"):
            self.browsing = Browsing(key, setting, value, folder)
        if key in self.browsed:
            edit = Edit(self.browsed.pop(key))
        return edit

    def typed(self, name: str, value: str, hint: str = "") -> Edit | None:
        """A line of text, an edit once it is left or Enter is pressed."""
        key = imgui.get_id(name)
        _, text = imgui.input_text_with_hint(f"##{name}", hint, self._typed.get(key, value))
        self.note(name)
        if imgui.is_item_active():
            self._typed[key] = str(text)
        elif imgui.is_item_deactivated_after_edit():
            self._typed.pop(key, None)
            return Edit(str(text)) if text != value else None
        else:
            self._typed.pop(key, None)
        return None


def _unit(setting: Setting) -> str:
    return f" {setting.unit}".rstrip().replace("%", "%%")


def _short(number: float, kind: str, lo: float, hi: float) -> Any:
    """ImGui's 32-bit number as one would type it: 0.35, not 0.3499999940395355; inside its range,
    which ImGui leaves when it rounds to the digits that show."""
    if kind == "int":
        return int(min(max(number, lo), hi))
    return min(max(float(f"{number:.6g}"), lo), hi)
