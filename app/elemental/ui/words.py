"""Text in the panel, and where things are: what every widget builds on."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from imgui_bundle import imgui

from elemental.ui import theme
from elemental.ui.theme import Fonts, Rgb

Rect = tuple[float, float, float, float]
"""(left, top, right, bottom) in pixels."""

FACT_GAP_EM = 1.2
"""Between facts on one line, in heights of the text."""


def shortened(text: str, width: float) -> str:
    """As much of the text as fits into ``width`` px, and dots."""
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        if imgui.calc_text_size(f"{text[:middle]}…").x <= width:
            low = middle
        else:
            high = middle - 1
    return f"{text[:low].rstrip()}…"


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

    def facts(self, name: str, facts: Sequence[tuple[str, str] | tuple[str, str, Rgb]]) -> None:
        """Words and figures side by side, on as many lines as they need; recorded as ``name``."""
        style, em = imgui.get_style(), imgui.get_font_size()
        imgui.begin_group()
        right = imgui.get_cursor_screen_pos().x + imgui.get_content_region_avail().x
        for number, (word, figure, *rgb) in enumerate(facts):
            with self.figures():
                width = imgui.calc_text_size(figure).x
            width += imgui.calc_text_size(word).x + style.item_inner_spacing.x
            if number and imgui.get_item_rect_max().x + FACT_GAP_EM * em + width <= right:
                imgui.same_line(0.0, FACT_GAP_EM * em)
            imgui.begin_group()
            self.text(word, rgb[0] if rgb else theme.MUTED)
            imgui.same_line(0.0, style.item_inner_spacing.x)
            with self.figures():
                self.text(figure)
            imgui.end_group()
        imgui.end_group()
        self.note(name)

    def cut(self, text: str, width: float, rgb: Rgb | None = None) -> None:
        """A line of at most ``width`` px; what is too long ends in dots, and a tooltip has it."""
        if imgui.calc_text_size(text).x <= width:
            self.text(text, rgb)
            return
        self.text(shortened(text, width), rgb)
        self.tooltip(text)

    def tell_if_cut(self, text: str) -> None:
        """A tooltip with the last item's text where the page is too narrow for it."""
        if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip.value):
            room = imgui.get_content_region_avail().x - 2.0 * imgui.get_font_size()
            if imgui.calc_text_size(text).x > room:
                imgui.set_tooltip(text)

    def flow(self, width: float) -> None:
        """Stay on the line if ``width`` more pixels fit, else go on on the next."""
        right = imgui.get_cursor_screen_pos().x + imgui.get_content_region_avail().x
        end = imgui.get_item_rect_max().x + imgui.get_style().item_spacing.x + width
        if end <= right:
            imgui.same_line()
