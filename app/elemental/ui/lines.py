"""Rows of a label, a value and a reset: side by side, or the value below on narrow pages."""

from __future__ import annotations

from imgui_bundle import imgui

from elemental.ui import icons, theme
from elemental.ui.words import Words

LABEL_SHARE = 0.44
"""Of a row's width, for its label."""
STACKED_BELOW_EM = 17.0
"""Rows narrower than this, in heights of the text, have their values below their labels."""


class Lines(Words):
    """Rows, between ``row`` and ``reset``. Labels are wrapped, never cut."""

    _row_end = 0.0

    def row(self, label: str, help: str = "", changed: bool = False, small: bool = False) -> None:
        """The label of a row; the value's widget follows, as wide as the rest. ``small``: it is a
        box to tick, and stays beside its label."""
        left, corner = imgui.get_cursor_pos_x(), imgui.get_cursor_screen_pos()
        width = imgui.get_content_region_avail().x
        self._row_end = left + width
        label_width, value_x = self._columns(width, small)
        imgui.align_text_to_frame_padding()
        imgui.push_text_wrap_pos(left + label_width)
        self.text(label, theme.ACCENT if changed else None)
        imgui.pop_text_wrap_pos()
        self.note(f"label {label}")
        self.tooltip(help)
        if value_x is None:
            imgui.set_cursor_screen_pos(
                imgui.ImVec2(corner.x, imgui.get_cursor_screen_pos().y - self._tuck())
            )
        else:
            imgui.same_line(left + value_x)
        imgui.set_next_item_width(-self.reset_width())

    def is_out_of_sight(self, label: str, small: bool = False) -> bool:
        """Whether the row that would begin here can't be seen; room is left for it then."""
        width = imgui.get_content_region_avail().x
        label_width, value_x = self._columns(width, small)
        frame = imgui.get_frame_height()
        text = imgui.calc_text_size(label, False, label_width).y
        padding = imgui.get_style().frame_padding.y
        height = max(frame, text + padding)
        if value_x is None:
            height += frame + imgui.get_style().item_spacing.y - self._tuck()
        if imgui.is_rect_visible(imgui.ImVec2(1.0, height)):
            return False
        imgui.dummy(imgui.ImVec2(1.0, height))
        return True

    def _columns(self, width: float, small: bool) -> tuple[float, float | None]:
        """(width of the label, where the value begins; None: on the next line), px."""
        gap = imgui.get_style().item_inner_spacing.x
        if width >= STACKED_BELOW_EM * imgui.get_font_size():
            return LABEL_SHARE * width - gap, LABEL_SHARE * width
        if small:
            begin = width - self.reset_width() - imgui.get_frame_height()
            return begin - gap, begin
        return width, None

    def _tuck(self) -> float:
        """How far a value moves up to the label above it, px."""
        return 0.5 * imgui.get_style().item_spacing.y

    def reset(self, name: str, changed: bool, default: str) -> bool:
        """The right end of a row: a button back to the default where the value is another."""
        if not changed:
            return False
        imgui.same_line(self._row_end - self.reset_width() + imgui.get_style().item_inner_spacing.x)
        imgui.push_style_color(imgui.Col_.button.value, theme.color(theme.BACKDROP, 0.0))
        imgui.push_style_color(imgui.Col_.text.value, theme.color(theme.ACCENT))
        imgui.push_style_var_x(imgui.StyleVar_.frame_padding.value, 2.0)
        pressed = imgui.button(f"{icons.RESET}###reset {name}")
        imgui.pop_style_var()
        imgui.pop_style_color(2)
        self.note(f"reset {name}")
        self.tooltip(f"back to {default}")
        return pressed

    def reset_width(self) -> float:
        """Room at a row's right end, px."""
        return imgui.get_font_size() + 4.0 + imgui.get_style().item_inner_spacing.x
