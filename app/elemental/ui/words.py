"""Text in the panel, and where things are: what every widget builds on."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from imgui_bundle import imgui

from elemental.ui import theme
from elemental.ui.theme import Fonts, Rgb

Rect = tuple[float, float, float, float]
"""(left, top, right, bottom) in pixels."""


class Words:
    """Lines, hints and tooltips. ``items`` is None where nobody asks for places."""

    def __init__(self, fonts: Fonts, records: bool = False) -> None:
        self.fonts = fonts
        self.items: dict[str, Rect] | None = {} if records else None
        self.page = ""

    def begin_frame(self) -> None:
        """Forget where things were."""
        if self.items is not None:
            self.items.clear()

    def note(self, label: str) -> None:
        """Record the last item under the page's name and ``label``, if it can be seen."""
        if self.items is not None and imgui.is_item_visible():
            low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
            self.items[f"{self.page}/{label}"] = (low.x, low.y, high.x, high.y)

    def text(self, text: str, rgb: Rgb | None = None) -> None:
        """A line, as it is."""
        if rgb is None:
            imgui.text_unformatted(text)
        else:
            imgui.push_style_color(imgui.Col_.text.value, theme.color(rgb))
            imgui.text_unformatted(text)
            imgui.pop_style_color()

    def hint(self, text: str) -> None:
        """A paragraph that explains, wrapped."""
        self.paragraph(text, theme.MUTED)

    def paragraph(self, text: str, rgb: Rgb) -> None:
        """Text of several lines, wrapped."""
        imgui.push_style_color(imgui.Col_.text.value, theme.color(rgb))
        imgui.push_text_wrap_pos(0.0)
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()
        imgui.pop_style_color()

    def tooltip(self, text: str) -> None:
        """What is told when the mouse rests on the last item."""
        if text and imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip.value):
            imgui.begin_tooltip()
            imgui.push_text_wrap_pos(imgui.get_font_size() * 24.0)
            imgui.text_unformatted(text)
            imgui.pop_text_wrap_pos()
            imgui.end_tooltip()

    @contextmanager
    def figures(self) -> Iterator[None]:
        """Text in figures of one width."""
        imgui.push_font(self.fonts.figures, 0.0)
        try:
            yield
        finally:
            imgui.pop_font()

    def flow(self, width: float) -> None:
        """Stay on the line if ``width`` more pixels fit, else go on on the next."""
        right = imgui.get_cursor_screen_pos().x + imgui.get_content_region_avail().x
        end = imgui.get_item_rect_max().x + imgui.get_style().item_spacing.x + width
        if end <= right:
            imgui.same_line()
